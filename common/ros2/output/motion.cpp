#include "ros2/output/motion.hpp"

#include <algorithm>
#include <cmath>

#include "samples/position/gives_position.hpp"

namespace fathom::ros2 {
namespace {

template <std::size_t N>
bool finite(const std::array<double, N>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

geo::Quaternion q_NB_of(const NavState& state) {
  return {state.q_NB[0], state.q_NB[1], state.q_NB[2], state.q_NB[3]};
}

bool is_unit(const std::array<double, 4>& q) {
  constexpr double kRounding = 1e-3;
  return finite(q) && std::abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0) < kRounding;
}

}  // namespace

Result<Attitude> attitude_of(const NavState& state, Convention convention) {
  if (state.mode == NavMode::none) return Error{"there is no navigation"};
  if (!is_unit(state.q_NB) || !finite(state.rpy_sigma_rad)) return Error{"the attitude is not known"};
  if (!finite(state.angular_rate_B_rad_s) || !finite(state.specific_force_B_m_s2)) {
    return Error{"angular rate or specific force is not known"};
  }
  const geo::Quaternion q = q_NB_of(state);
  Attitude out;
  out.stamp_ns = state.header.stamp_ns;
  out.q_WF = q_WF(convention, q);
  out.rotation_covariance_W =
      rotated(R_WN(convention), rotation_covariance_N(q, geo::vec(state.rpy_sigma_rad)));
  out.angular_rate_F_rad_s = R_FB(convention) * geo::vec(state.angular_rate_B_rad_s);
  out.specific_force_F_m_s2 = R_FB(convention) * geo::vec(state.specific_force_B_m_s2);
  return out;
}

std::optional<geo::Geodetic> place_of(const NavState& state) {
  if (!gives_position(state.mode)) return std::nullopt;
  const geo::Geodetic place{state.latitude_rad, state.longitude_rad, state.altitude_m};
  if (!std::isfinite(place.latitude_rad) || !std::isfinite(place.longitude_rad) ||
      !std::isfinite(place.altitude_m)) {
    return std::nullopt;
  }
  return place;
}

Result<Motion> motion_of(const NavState& state, Convention convention, const geo::Geodetic& origin) {
  const auto place = place_of(state);
  if (!place) return Error{"the position is not to be used"};
  if (!is_unit(state.q_NB) || !finite(state.angular_rate_B_rad_s)) return Error{"the attitude is not known"};
  if (!finite(state.velocity_N_m_s)) return Error{"the velocity is not known"};
  if (!finite(state.position_covariance_N_m2) || !finite(state.velocity_covariance_N_m2_s2)) {
    return Error{"the uncertainty is not known"};
  }
  const geo::Quaternion q = q_NB_of(state);
  const Eigen::Matrix3d R_BN = geo::to_matrix(geo::normalized(q)).transpose();
  const Eigen::Matrix3d P_N = matrix3(state.position_covariance_N_m2);
  const Eigen::Vector3d v_N = geo::vec(state.velocity_N_m_s);
  Motion out;
  out.mode = state.mode;
  out.place = *place;
  out.position_covariance_ENU = rotated(R_WN(Convention::enu_flu), P_N);
  out.position_covariance_W = rotated(R_WN(convention), P_N);
  out.map.stamp_ns = state.header.stamp_ns;
  out.map.pose.position_m = R_WN(convention) * geo::difference_N(origin, *place);
  out.map.pose.q = q_WF(convention, q);
  out.map.velocity_W_m_s = R_WN(convention) * v_N;
  out.map.angular_rate_F_rad_s = R_FB(convention) * geo::vec(state.angular_rate_B_rad_s);
  out.velocity_F_m_s = R_FB(convention) * R_BN * v_N;
  out.velocity_covariance_F = rotated(R_FB(convention) * R_BN, matrix3(state.velocity_covariance_N_m2_s2));
  return out;
}

}  // namespace fathom::ros2
