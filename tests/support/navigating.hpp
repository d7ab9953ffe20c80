#pragma once

#include "samples/nav_state.hpp"

namespace fathom::test {

/// A vehicle that reckons its way north at 1.5 m/s, level and 5 m below the ellipsoid, and knows it well.
[[nodiscard]] inline NavState navigating(TimeNs now_ns, std::uint64_t sequence) {
  NavState out;
  out.header = {"auv", "fusion", now_ns, now_ns, sequence};
  out.mode = NavMode::dead_reckoning;
  out.alignment = AlignmentPhase::aligned;
  out.latitude_rad = -0.5;
  out.longitude_rad = 2.0;
  out.altitude_m = -5.0;
  out.velocity_N_m_s = {1.5, 0.0, 0.0};
  out.q_NB = {1.0, 0.0, 0.0, 0.0};
  out.rpy_rad = {0.0, 0.0, 0.0};
  out.angular_rate_B_rad_s = {0.0, 0.0, 0.0};
  out.position_covariance_N_m2 = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  out.velocity_covariance_N_m2_s2 = out.position_covariance_N_m2;
  out.rpy_sigma_rad = {0.001, 0.001, 0.01};
  return out;
}

}  // namespace fathom::test
