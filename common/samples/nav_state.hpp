#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// What the navigation state rests on right now.
enum class NavMode : std::uint8_t {
  none = 0,      ///< no navigation state yet
  aligning = 1,  ///< attitude only, position not to be used
  gps_aided = 2,
  acoustic_aided = 3,  ///< USBL, no GPS
  dead_reckoning = 4,  ///< velocity aided (DVL, water track, airspeed), no position fixes
  inertial = 5,        ///< free inertial
};
[[nodiscard]] std::string_view to_string(NavMode mode);

enum class AlignmentPhase : std::uint8_t {
  none = 0,
  waiting = 1,  ///< for stability or for motion
  averaging = 2,
  coarse = 3,
  fine = 4,
  aligned = 5,
  timed_out = 6,
  lost = 7,
};
[[nodiscard]] std::string_view to_string(AlignmentPhase phase);

/// Navigation state at an inertial sample. header.stamp_ns: instant of validity; header.received_ns: arrival
/// of the inertial sample at its bridge; header.sensor: the fusion instance.
struct NavState {
  SampleHeader header;
  NavMode mode = NavMode::none;
  AlignmentPhase alignment = AlignmentPhase::none;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double altitude_m = kUnknown;               ///< above the WGS-84 ellipsoid, up
  double depth_m = kUnknown;                  ///< below the surface, down
  double altitude_above_bottom_m = kUnknown;  ///< as the altimeter heard it; NaN where that is not fresh
  std::array<double, 3> velocity_N_m_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 4> q_NB{kUnknown, kUnknown, kUnknown, kUnknown};         ///< Hamilton, w first, B into N
  std::array<double, 3> rpy_rad{kUnknown, kUnknown, kUnknown};                ///< roll, pitch, yaw (ZYX)
  std::array<double, 3> angular_rate_B_rad_s{kUnknown, kUnknown, kUnknown};   ///< bias-corrected
  std::array<double, 3> specific_force_B_m_s2{kUnknown, kUnknown, kUnknown};  ///< bias-corrected
  std::array<double, 9> position_covariance_N_m2{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown,
                                                 kUnknown, kUnknown, kUnknown, kUnknown};  ///< row-major
  std::array<double, 9> velocity_covariance_N_m2_s2{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown,
                                                    kUnknown, kUnknown, kUnknown, kUnknown};
  std::array<double, 3> rpy_sigma_rad{kUnknown, kUnknown, kUnknown};
  double gps_outage_s = kUnknown;   ///< since the last GPS fix was used; NaN before the first
  double dvl_outage_s = kUnknown;   ///< since the last DVL velocity was used; NaN before the first
  std::uint32_t reset_counter = 0;  ///< grows with every step of the position that is not motion
  std::array<double, 3> last_reset_delta_N_m{0.0, 0.0, 0.0};
};

}  // namespace fathom
