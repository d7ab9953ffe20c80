#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "codec/codec.hpp"
#include "samples/dvl.hpp"

namespace fathom::codec::pd0 {

/// Velocity as recorded (sign and axes of PD0: bottom or water relative to the DVL), m/s; bad is unknown.
/// Beams 1 to 4, or three axes and the error velocity.
struct Velocity {
  std::array<double, 4> recorded_m_s{kUnknown, kUnknown, kUnknown, kUnknown};
  double sigma_m_s = kUnknown;
};

struct BottomTrack {
  Velocity bottom;
  std::array<double, 4> range_m{kUnknown, kUnknown, kUnknown, kUnknown};
  double altitude_m = kUnknown;
  std::optional<Velocity> water;  ///< when at least one of its numbers is good
};

/// What a DVL velocity needs of an ensemble.
struct Ensemble {
  DvlFrame frame = DvlFrame::beam;
  bool convex = true;
  bool upward = false;
  bool tilts_used = false;
  double beam_angle_rad = kUnknown;
  double heading_rad = kUnknown;
  double pitch_rad = kUnknown;  ///< as recorded
  double roll_rad = kUnknown;
  double sound_speed_m_s = kUnknown;
  std::optional<TimeNs> clock_ns;
  std::optional<BottomTrack> track;
};

/// Reads one ensemble whose length and checksum are right. `bytes` is all of it, checksum included.
[[nodiscard]] std::variant<Ensemble, RejectReason> read_ensemble(std::span<const std::uint8_t> bytes);

}  // namespace fathom::codec::pd0
