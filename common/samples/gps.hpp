#pragma once

#include <array>
#include <cstdint>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// Quality of a satellite fix, ordered by what it is worth.
enum class GpsFix : std::uint8_t {
  none = 0,
  time_only = 1,
  dead_reckoning = 2,  ///< estimated, manual or simulated: not a satellite measurement
  fix_2d = 3,
  fix_3d = 4,
  differential = 5,
  rtk_float = 6,
  rtk_fixed = 7,
};

/// What a receiver itself says of interference, the worse the later.
enum class GpsJamming : std::uint8_t {
  unknown = 0,  ///< nothing said, or its detection is off
  none = 1,
  warning = 2,  ///< interference, and still a fix
  critical = 3,
};
enum class GpsSpoofing : std::uint8_t {
  unknown = 0,
  none = 1,
  indicated = 2,  ///< one sign of it
  affirmed = 3,   ///< several: what such a receiver reports is somebody else's position
};

struct GpsSample {
  SampleHeader header;
  GpsFix fix = GpsFix::none;
  std::int32_t satellites =
      -1;  ///< used in the solution; -1 where the protocol did not say (a count, not a quantity)
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double altitude_m = kUnknown;      ///< above the WGS-84 ellipsoid, up
  double altitude_msl_m = kUnknown;  ///< above mean sea level, up
  std::array<double, 3> position_sigma_N_m{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> velocity_N_m_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> velocity_sigma_N_m_s{kUnknown, kUnknown, kUnknown};
  double hdop = kUnknown;
  double course_rad = kUnknown;  ///< over ground, from true north
  GpsJamming jamming = GpsJamming::unknown;
  GpsSpoofing spoofing = GpsSpoofing::unknown;
};

}  // namespace fathom
