#pragma once

#include <array>
#include <cstdint>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// What a DVL velocity is relative to.
enum class DvlMode : std::uint8_t { bottom = 0, water = 1 };

/// The frame in which the instrument recorded the velocity, before it was turned into FRD of the DVL.
enum class DvlFrame : std::uint8_t { beam = 0, instrument = 1, ship = 2, earth = 3 };

/// Velocity of the vehicle relative to bottom or water, forward-right-down in the DVL's own axes D.
/// A component that the instrument declared bad is NaN; so is a beam.
struct DvlSample {
  SampleHeader header;
  DvlMode mode = DvlMode::bottom;
  DvlFrame recorded_frame = DvlFrame::instrument;
  std::array<double, 3> velocity_D_m_s{kUnknown, kUnknown, kUnknown};
  double error_velocity_m_s = kUnknown;
  double sigma_m_s = kUnknown;  ///< the instrument's own figure, one component
  /// Vehicle velocity projected on the outward (downward) direction of each beam.
  std::array<double, 4> beam_velocity_m_s{kUnknown, kUnknown, kUnknown, kUnknown};
  std::array<double, 4> beam_range_m{kUnknown, kUnknown, kUnknown, kUnknown};  ///< as the instrument gives it
  double beam_angle_rad = kUnknown;   ///< between a beam and the instrument's down axis
  double altitude_m = kUnknown;       ///< height above the bottom
  double sound_speed_m_s = kUnknown;  ///< that the instrument used
  /// Attitude that the instrument itself measured or was told.
  double roll_rad = kUnknown;
  double pitch_rad = kUnknown;
  double heading_rad = kUnknown;
};

}  // namespace fathom
