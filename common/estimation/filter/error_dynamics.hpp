#pragma once

#include "estimation/filter/nav_solution.hpp"

namespace fathom::estimation {

using Matrix9 = Eigen::Matrix<double, kNavStates, kNavStates>;
/// Columns: the states that drive the navigation error, in StateIndex order from index 9 on.
using ImuColumns = Eigen::Matrix<double, kNavStates, Eigen::Dynamic, 0, kNavStates, 24>;

/// F of DYN-1 in 3 x 3 blocks of position r (m along N), velocity v and attitude phi. The others are the
/// identity (v on r) or zero; [force x] and -[rate_in x] stand for phi on v and on itself.
struct ErrorRates {
  Eigen::Matrix3d r_r;
  Eigen::Matrix3d v_r;
  Eigen::Matrix3d v_v;
  Eigen::Matrix3d phi_r;
  Eigen::Matrix3d phi_v;
  Eigen::Vector3d force_N_m_s2;
  Eigen::Vector3d rate_in_N_rad_s;
};
[[nodiscard]] ErrorRates error_rates(const geo::LocalEarth& earth, const Eigen::Vector3d& v_N_m_s,
                                     const Eigen::Vector3d& force_N_m_s2);

/// The whole of F, dx/dt = F x.
[[nodiscard]] Matrix9 error_dynamics(const NavSolution& nav, const Eigen::Vector3d& force_N_m_s2);

/// What one unit of remaining bias, scale or misalignment of the inertial unit does to the rates of the nine
/// navigation errors (DYN-2).
[[nodiscard]] ImuColumns imu_error_columns(const StateIndex& index, const Eigen::Matrix3d& C_NB,
                                           const Eigen::Vector3d& rate_B_rad_s,
                                           const Eigen::Vector3d& force_B_m_s2);

/// Rate or specific force with the estimated bias, scale and misalignment taken off (IMU-1), to first order
/// in scale and misalignment. `x` by StateIndex.
[[nodiscard]] Eigen::Vector3d corrected_rate(const StateIndex& index, const std::array<double, kMaxStates>& x,
                                             const Eigen::Vector3d& measured_rad_s);
[[nodiscard]] Eigen::Vector3d corrected_force(const StateIndex& index,
                                              const std::array<double, kMaxStates>& x,
                                              const Eigen::Vector3d& measured_m_s2);

}  // namespace fathom::estimation
