#pragma once

#include <optional>

#include "estimation/alignment/moving_start.hpp"
#include "estimation/alignment/velocity_track.hpp"

namespace fathom::estimation {

struct AccelerationStartInputs {
  Eigen::Vector3d gravity_N_m_s2;  ///< less the Coriolis acceleration of the motion
  Eigen::Vector3d lever_B_m;       ///< of the antenna, from the inertial unit
  double velocity_random_walk_m_s_sqrt_s;
  double angle_random_walk_rad_sqrt_s;
  double accel_bias_sigma_m_s2;
  double accel_shape_sigma_m_s2;        ///< what scale and misalignment make of one g
  double unexplained_force_sigma_m_s2;  ///< of that, what is joined to no state
  double gyro_bias_sigma_rad_s;
  double turn_error_sigma;  ///< of a turn, by scale and misalignment: radians per radian
  double latency_sigma_s;   ///< of the velocities' instants
};

struct AccelerationStart {
  MovingStart start;
  Eigen::Vector3d sigma_N_rad;  ///< of the rotation about N; the last is that of the heading
};

/// (ALN-24): attitude and velocity now, by how the velocities change and what was felt meanwhile. Needs
/// neither course nor compass, but accelerations. None with fewer than six velocities, where two attitudes
/// explain them about as well, where none does, or where what was measured is no number.
[[nodiscard]] std::optional<AccelerationStart> start_by_accelerations(const VelocityTrack& track,
                                                                      const AccelerationStartInputs& in);

}  // namespace fathom::estimation
