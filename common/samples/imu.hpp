#pragma once

#include <array>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// Inertial measurement in the body frame B (forward, right, down). At rest and level the specific force is
/// (0, 0, -g).
struct ImuSample {
  SampleHeader header;
  std::array<double, 3> angular_rate_B_rad_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> specific_force_B_m_s2{kUnknown, kUnknown, kUnknown};
  /// Increments integrated inside the instrument over the last delta_time_s; unknown where it gives rates
  /// only.
  std::array<double, 3> delta_angle_B_rad{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> delta_velocity_B_m_s{kUnknown, kUnknown, kUnknown};
  double delta_time_s = kUnknown;
  double temperature_degC = kUnknown;
};

}  // namespace fathom
