#include "study/baselines/fixed_gain.hpp"

#include <cmath>

#include "geo/wgs84.hpp"

namespace fathom::study::fixed_gain {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Eigen::Matrix<double, 4, 3> quaternion_rate(const geo::Quaternion& lambda) {
  // (FIX-1)
  const Vector3d q(lambda.x, lambda.y, lambda.z);
  Eigen::Matrix<double, 4, 3> phi;
  phi.row(0) = -q.transpose();
  phi.bottomRows<3>() = lambda.w * Matrix3d::Identity() + geo::skew(q);
  return phi;
}

Matrix3d inertial_to_tangent(double latitude_rad, double t_s) {
  // (FIX-2)
  const double angle = geo::kEarthRate_rad_s * t_s;
  const Vector3d axis = geo::earth_rate_N(latitude_rad) / geo::kEarthRate_rad_s;
  return std::cos(angle) * Matrix3d::Identity() - std::sin(angle) * geo::skew(axis) +
         (1.0 - std::cos(angle)) * axis * axis.transpose();
}

Vector3d centripetal(double latitude_rad, double radius_m) {
  const Vector3d u = geo::earth_rate_N(latitude_rad);
  return geo::cross(u, geo::cross(u, Vector3d(0.0, 0.0, -radius_m)));
}

Matrix9 transition(double latitude_rad, double dt_s, const Vector3d& f_T_m_s2) {
  // (FIX-3)
  const Matrix3d a = inertial_to_tangent(latitude_rad, dt_s);
  const Matrix3d tilt = -dt_s * geo::skew(f_T_m_s2);
  Matrix9 out = Matrix9::Zero();
  out.block<3, 3>(0, 0) = a;
  out.block<3, 3>(3, 0) = 0.5 * dt_s * a * tilt;
  out.block<3, 3>(3, 3) = a;
  out.block<3, 3>(3, 6) = dt_s * a;
  out.block<3, 3>(6, 0) = a * tilt;
  out.block<3, 3>(6, 6) = a;
  return out;
}

Eigen::Matrix2d closed_loop_rate(const Gains& gains) {
  // (FIX-4)
  Eigen::Matrix2d a;
  a << 0.0, 1.0, -gains.position_1_s2, -gains.velocity_1_s;
  return a;
}

Eigen::Matrix2d closed_loop_step(const Gains& gains, double dt_s) {
  // (FIX-4)
  Eigen::Matrix2d drift;
  drift << 1.0, dt_s, 0.0, 1.0;
  const Eigen::Vector2d push(0.5 * dt_s * dt_s, dt_s);
  return drift - push * Eigen::RowVector2d(gains.position_1_s2, gains.velocity_1_s);
}

double attitude_factor(const Gains& gains, double dt_s) {
  return 1.0 - gains.attitude_1_s * dt_s;
}

}  // namespace fathom::study::fixed_gain
