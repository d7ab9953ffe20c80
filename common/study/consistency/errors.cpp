#include "study/consistency/errors.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "samples/uncertainty.hpp"

namespace fathom::study {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double normalised(const Vector3d& error, const std::array<double, 9>& covariance) {
  const Matrix3d p = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(covariance.data());
  return error.dot(p.inverse() * error);
}

Matrix3d axes_of(const std::array<double, 4>& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

}  // namespace

Errors errors_of(const NavState& nav, const Eigen::Matrix<double, 9, 9>& covariance, const Pose& truth) {
  Errors out;
  const Eigen::AngleAxisd turn(truth.axes_NB * axes_of(nav.q_NB).transpose());
  const Eigen::Vector2d tilt = (turn.angle() * turn.axis()).head<2>();
  const Eigen::Matrix2d p = covariance.block<2, 2>(6, 6);
  out.tilt_rad = tilt.norm();
  out.tilt = tilt.dot(p.inverse() * tilt);
  const double heading = std::atan2(truth.axes_NB(1, 0), truth.axes_NB(0, 0));
  out.heading_rad = std::remainder(nav.rpy_rad[2] - heading, 2.0 * std::numbers::pi);
  out.heading = std::pow(out.heading_rad / nav.rpy_sigma_rad[2], 2);
  const Vector3d velocity = Vector3d(nav.velocity_N_m_s.data()) - truth.velocity_N_m_s;
  out.velocity = normalised(velocity, nav.velocity_covariance_N_m2_s2);
  const Vector3d position =
      ecef::offset_N_m(truth.place, {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
  out.position = normalised(position, nav.position_covariance_N_m2);
  out.horizontal_m = position.head<2>().norm();
  out.covered = out.horizontal_m <= horizontal_95_m(nav.position_covariance_N_m2);
  return out;
}

}  // namespace fathom::study
