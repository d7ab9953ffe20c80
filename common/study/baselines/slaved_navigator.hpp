#pragma once

#include "estimation/filter/strapdown.hpp"
#include "study/baselines/embedded_dynamics.hpp"

namespace fathom::study::hydro {

using estimation::NavSolution;

/// An inertial navigator whose altitude follows a depth gauge; the horizontal runs free until somebody
/// corrects it. What the published filter watches.
class SlavedNavigator {
 public:
  void start(const NavSolution& nav, double surface_altitude_m);
  /// One inertial interval; the gyro bias in use is taken off.
  void advance(const Eigen::Vector3d& dtheta_rad, const Eigen::Vector3d& dv_m_s, double dt_s);
  /// A depth (m) that came `dt_s` after the one before: second-order slaving of altitude and v_D.
  void slave(double depth_m, double dt_s);

  [[nodiscard]] const NavSolution& nav() const { return nav_; }
  /// Angular rate of B relative to N over the last interval.
  [[nodiscard]] const Eigen::Vector3d& rate_nb_B_rad_s() const { return rate_nb_B_; }
  /// Mean since the last call.
  [[nodiscard]] NavigatorView view();

  /// Takes off errors that were found (estimate - truth): position north, east (m), velocity north, east,
  /// attitude.
  void correct(const Eigen::Matrix<double, 7, 1>& error);
  void correct_gyro_bias(const Eigen::Vector3d& more_rad_s) { gyro_bias_B_ += more_rad_s; }

 private:
  NavSolution nav_;
  double surface_altitude_m_ = 0.0;
  Eigen::Vector3d gyro_bias_B_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d dtheta_before_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d dv_before_ = Eigen::Vector3d::Zero();
  bool has_before_ = false;
  Eigen::Vector3d rate_nb_B_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_sum_N_ = Eigen::Vector3d::Zero();
  double force_s_ = 0.0;
};

}  // namespace fathom::study::hydro
