#pragma once

#include <array>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "samples/nav_state.hpp"

namespace fathom::ros2::test {

inline constexpr TimeNs kStart_ns = 1'700'000'000 * kNsPerSecond;

/// A state that can be used, at a place, with an attitude in roll, pitch, yaw.
inline NavState state_at(const geo::Geodetic& place, const Eigen::Vector3d& rpy_rad = {0, 0, 0}) {
  NavState out;
  out.header = {"auv", "fusion", kStart_ns, kStart_ns, 1};
  out.mode = NavMode::gps_aided;
  out.alignment = AlignmentPhase::aligned;
  out.latitude_rad = place.latitude_rad;
  out.longitude_rad = place.longitude_rad;
  out.altitude_m = place.altitude_m;
  out.velocity_N_m_s = {1.0, 0.5, -0.25};
  const geo::Quaternion q = geo::from_rpy(rpy_rad);
  out.q_NB = {q.w, q.x, q.y, q.z};
  out.rpy_rad = geo::arr(rpy_rad);
  out.angular_rate_B_rad_s = {0.01, 0.02, 0.03};
  out.specific_force_B_m_s2 = {0.1, 0.2, -9.8};
  out.position_covariance_N_m2 = {1.0, 0.5, 0.2, 0.5, 4.0, -0.3, 0.2, -0.3, 9.0};
  out.velocity_covariance_N_m2_s2 = {0.01, 0, 0, 0, 0.04, 0, 0, 0, 0.09};
  out.rpy_sigma_rad = {0.001, 0.002, 0.01};
  return out;
}

}  // namespace fathom::ros2::test
