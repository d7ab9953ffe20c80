#pragma once

#include "estimation/nav_solution.hpp"

namespace fathom::estimation {

using Matrix9 = Eigen::Matrix<double, kNavStates, kNavStates>;
/// Columns: the states that drive the navigation error, in StateIndex order from index 9 on.
using ImuColumns = Eigen::Matrix<double, kNavStates, Eigen::Dynamic, 0, kNavStates, 24>;

/// dx/dt = F x for position (m, NED), velocity and attitude error (DYN-1). Position error in metres along N.
[[nodiscard]] Matrix9 error_dynamics(const NavSolution& nav, const Eigen::Vector3d& f_N_m_s2);

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
