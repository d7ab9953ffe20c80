#pragma once

#include "estimation/filter/error_dynamics.hpp"

namespace fathom::estimation {

/// Doubles from one row of a covariance to the next, the same for every configuration, so that the loops over
/// columns address all rows from one pointer. An odd number of cache lines: the rows of one column do not
/// compete for the same places in the cache.
inline constexpr int kRowStride = kMaxStates + 8;

/// How the nine navigation errors move in one step: x' = A x_nav + B x_imu, the first nine rows of
/// I + F dt + F^2 dt^2/2 (KF-1), evaluated as x + d + F dt d/2 with d = F dt x. A and B are never formed:
/// what is known to be zero costs nothing.
class NavTransition {
 public:
  /// Rate and force are those of the step, corrected, along B.
  NavTransition(const StateIndex& index, const ErrorRates& rates, const Eigen::Matrix3d& C_NB,
                const Eigen::Vector3d& rate_B_rad_s, const Eigen::Vector3d& force_B_m_s2, double dt_s);
  /// The same from the navigation solution.
  NavTransition(const StateIndex& index, const NavSolution& nav, const Eigen::Vector3d& rate_B_rad_s,
                const Eigen::Vector3d& force_B_m_s2, double dt_s);

  [[nodiscard]] double dt_s() const { return dt_s_; }
  /// Navigation states and those that drive them, as far as they are estimated.
  [[nodiscard]] int driven() const { return driven_; }

  /// `rows` points to row 0 of a matrix whose rows are error states, kRowStride apart; the first nine are
  /// replaced by A x_nav + B x_imu, in `columns` columns.
  void apply(double* rows, int columns) const;

  /// The first columns of the nine rows, by applying it to the identity.
  using Rows = Eigen::Matrix<double, kNavStates, Eigen::Dynamic, 0, kNavStates, kMaxStates>;
  [[nodiscard]] Rows rows(int columns) const;

 private:
  void move(double* nav, const double* imu, int columns) const;

  double dt_s_;
  int driven_;
  int accel_scale_;  ///< first states of the groups, -1 where they are not estimated
  int gyro_scale_;
  int accel_misalignment_;
  int gyro_misalignment_;
  bool biases_only_;
  Eigen::Vector3d rate_B_;
  Eigen::Vector3d force_B_;
  // Blocks times the step; names as in ErrorRates.
  Eigen::Matrix3d r_r_;
  Eigen::Matrix3d v_r_;
  Eigen::Matrix3d v_v_;
  Eigen::Matrix3d phi_r_;
  Eigen::Matrix3d phi_v_;
  Eigen::Matrix3d c_;
  Eigen::Vector3d force_;
  Eigen::Vector3d turn_;
};

}  // namespace fathom::estimation
