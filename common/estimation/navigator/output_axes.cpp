// Which axes are published, and how well they are known.
#include <algorithm>
#include <cmath>

#include "estimation/navigator/estimate.hpp"

namespace fathom::estimation {

using Eigen::Vector3d;

Vector3d rpy_sigma_rad(const Setup& setup, const Estimate& estimate) {
  return rpy_sigma_rad(output_attitude(setup, estimate));
}

Vector3d rpy_sigma_rad(const OutputAttitude& output) {
  // (OUT-1): how roll, pitch and yaw turn with the attitude error about N.
  const Eigen::Matrix3d c = geo::to_matrix(output.q_NO);
  const double level = std::max(std::sqrt(c(0, 0) * c(0, 0) + c(1, 0) * c(1, 0)), 1e-3);  // cos(pitch)
  const double cosine = c(0, 0) / level;                                                  // of yaw
  const double sine = c(1, 0) / level;
  const double tangent = -c(2, 0) / level;  // of pitch
  Eigen::Matrix3d j;
  j << -cosine / level, -sine / level, 0.0, sine, -cosine, 0.0, -cosine * tangent, -sine * tangent, -1.0;
  return (j * output.covariance_N * j.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
}

OutputAttitude output_attitude(const Setup& setup, const Estimate& estimate) {
  const ErrorFilter& filter = estimate.filter;
  const FilterState& state = estimate.state;
  OutputAttitude out;
  out.q_NO = state.nav.q_NB;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) out.covariance_N(i, k) = filter(6 + i, 6 + k);
  const NonHolonomicConfig& wheels = setup.config.constraints.non_holonomic;
  if (setup.config.output_axes == OutputAxes::body || !wheels.enabled) return out;
  // (OUT-3)
  const int mount = setup.index.of(Group::mount_angles);
  Vector3d angles = Vector3d::Zero();
  if (mount >= 0) {
    const auto at = static_cast<std::size_t>(mount);
    angles.tail<2>() = Eigen::Vector2d(state.x[at], state.x[at + 1]);
  }
  const geo::Quaternion q_BO = setup.q_B_wheels * geo::exp(angles);
  out.C_BO = geo::to_matrix(q_BO);
  out.q_NO = geo::normalized(state.nav.q_NB * q_BO);
  if (mount < 0) return out;
  const Eigen::Matrix<double, 3, 2> turn = geo::to_matrix(out.q_NO).rightCols<2>();
  Eigen::Matrix<double, 3, 2> shared;  // of the attitude error and the mount angles
  Eigen::Matrix2d own;
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < 3; ++i) shared(i, k) = filter(6 + i, mount + k);
    for (int i = 0; i < 2; ++i) own(i, k) = filter(mount + i, mount + k);
  }
  const Eigen::Matrix3d cross = shared * turn.transpose();
  out.covariance_N += cross + cross.transpose() + turn * own * turn.transpose();
  return out;
}

}  // namespace fathom::estimation
