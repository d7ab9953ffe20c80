#pragma once

#include <optional>

#include "estimation/alignment/velocity_window.hpp"

namespace fathom::estimation {

/// Attitude and velocity now, from two velocities and the way between them, with the errors that they carry.
/// Rotations are those of the attitude error about N, as in the filter.
struct MovingStart {
  geo::Quaternion q_NB;
  Eigen::Vector3d v_N_m_s = Eigen::Vector3d::Zero();        ///< of the inertial unit
  Eigen::Matrix3d P_vv = Eigen::Matrix3d::Zero();           ///< m^2/s^2
  Eigen::Matrix3d P_vp = Eigen::Matrix3d::Zero();           ///< velocity by rotation, m/s rad
  Eigen::Matrix3d P_pp = Eigen::Matrix3d::Zero();           ///< rotation without the biases, rad^2
  Eigen::Matrix3d by_accel_bias = Eigen::Matrix3d::Zero();  ///< rotation by bias, rad/(m/s^2)
  Eigen::Matrix3d by_gyro_bias = Eigen::Matrix3d::Zero();   ///< rotation by bias, s
  Eigen::Vector3d by_heading = Eigen::Vector3d::Zero();     ///< rotation by a heading found too far clockwise
  Eigen::Vector3d mean_force_B_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_rate_B_rad_s = Eigen::Vector3d::Zero();
};

struct MovingStartInputs {
  Eigen::Vector3d gravity_N_m_s2;  ///< less the Coriolis acceleration of the motion
  Eigen::Vector3d lever_B_m;       ///< of the antenna, from the inertial unit
  /// Of the forward axis now, where a compass tells it; else `course_axis_B` has the course of the last
  /// velocity.
  std::optional<double> heading_rad;
  double heading_sigma_rad;      ///< of that, or of the angle between that axis and the course
  double force_sigma_m_s2;       ///< of each axis of the mean specific force, its bias excepted
  double accel_bias_sigma_m_s2;  ///< what the bias may be: more than that makes the level uncertain
  /// What went along the course at the last velocity: the forward axis, or what a DVL measured. A unit
  /// vector.
  Eigen::Vector3d course_axis_B = Eigen::Vector3d::UnitX();
  /// Whether the error of that velocity is known to turn the heading with it, or counted as one of its own.
  bool joint_course = false;
};

/// (ALN-6). None where the vehicle points so far up or down that a course says nothing of its heading, where
/// hardly any force was felt, or where what was measured is no number.
[[nodiscard]] std::optional<MovingStart> start_moving(const VelocityWindow& window,
                                                      const MovingStartInputs& in);

}  // namespace fathom::estimation
