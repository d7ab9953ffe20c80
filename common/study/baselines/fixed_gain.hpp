#pragma once

#include <Eigen/Core>

#include "geo/so3.hpp"

/// Pieces of the published fixed-gain GPS/INS algorithm, corrected: quaternion from body to an inertial
/// frame, an Earth-fixed tangent frame at the start, and position feedback with fixed poles. It is the
/// baseline that the filter is compared with. Errors here are truth - computed.
namespace fathom::study::fixed_gain {

using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// Phi(lambda) of d lambda/dt = 1/2 Phi omega_B, lambda from body to inertial (FIX-1).
[[nodiscard]] Eigen::Matrix<double, 4, 3> quaternion_rate(const geo::Quaternion& lambda);

/// Turns from the inertial frame, which was the tangent frame at time 0, into the tangent frame at `t_s`
/// (FIX-2).
[[nodiscard]] Eigen::Matrix3d inertial_to_tangent(double latitude_rad, double t_s);

/// u x (u x [0, 0, -R]): what the tangent frame's circle around the Earth's axis adds to gravitation, m/s^2.
[[nodiscard]] Eigen::Vector3d centripetal(double latitude_rad, double radius_m);

/// Transition of [attitude, r, p = v + u x r] errors over one step (FIX-3). `f_T_m_s2`: specific force in the
/// tangent frame.
[[nodiscard]] Matrix9 transition(double latitude_rad, double dt_s, const Eigen::Vector3d& f_T_m_s2);

/// Feedback of what GPS says is missing: acceleration c_r dr + c_p dp, attitude rate c_w (FIX-4).
struct Gains {
  double attitude_1_s = 5.0;
  double position_1_s2 = 8.0;
  double velocity_1_s = 4.0;
};
/// [dr, dp] of one axis in one step with the feedback: continuous d/dt matrix, and the discrete transition in
/// which the feedback acts as an acceleration held over the step.
[[nodiscard]] Eigen::Matrix2d closed_loop_rate(const Gains& gains);
[[nodiscard]] Eigen::Matrix2d closed_loop_step(const Gains& gains, double dt_s);
/// Share of an attitude error that one step leaves.
[[nodiscard]] double attitude_factor(const Gains& gains, double dt_s);

}  // namespace fathom::study::fixed_gain
