#include "ros2/frames/convention.hpp"

#include <cmath>
#include <numbers>

namespace fathom::ros2 {
namespace {

// Half turns: about the bisector of north and east, and about forward.
constexpr double kRoot = 1.0 / std::numbers::sqrt2;
constexpr geo::Quaternion kHalfTurn_WN{0.0, kRoot, kRoot, 0.0};
constexpr geo::Quaternion kHalfTurn_FB{0.0, 1.0, 0.0, 0.0};

geo::Quaternion with_positive_w(const geo::Quaternion& q) {
  const geo::Quaternion unit = geo::normalized(q);
  return unit.w < 0.0 ? geo::Quaternion{-unit.w, -unit.x, -unit.y, -unit.z} : unit;
}

}  // namespace

Eigen::Matrix3d R_WN(Convention convention) {
  if (convention == Convention::ned_frd) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d out;
  out << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  return out;
}

Eigen::Matrix3d R_FB(Convention convention) {
  if (convention == Convention::ned_frd) return Eigen::Matrix3d::Identity();
  return Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
}

geo::Quaternion q_WF(Convention convention, const geo::Quaternion& q_NB) {
  if (convention == Convention::ned_frd) return with_positive_w(q_NB);
  return with_positive_w(kHalfTurn_WN * q_NB * geo::conjugate(kHalfTurn_FB));
}

geo::Quaternion q_NB(Convention convention, const geo::Quaternion& q_WF) {
  if (convention == Convention::ned_frd) return with_positive_w(q_WF);
  return with_positive_w(geo::conjugate(kHalfTurn_WN) * q_WF * kHalfTurn_FB);
}

Eigen::Matrix3d rotation_covariance_N(const geo::Quaternion& q_NB, const Eigen::Vector3d& rpy_sigma_rad) {
  const double yaw = geo::to_rpy(q_NB).z();
  Eigen::Matrix3d axes;
  axes.col(0) = geo::to_matrix(q_NB).col(0);
  axes.col(1) = Eigen::Vector3d(-std::sin(yaw), std::cos(yaw), 0.0);
  axes.col(2) = Eigen::Vector3d::UnitZ();
  return axes * rpy_sigma_rad.cwiseAbs2().asDiagonal() * axes.transpose();
}

Covariance3 covariance3(const Eigen::Matrix3d& m) {
  Covariance3 out{};
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      out[static_cast<std::size_t>(3 * row + column)] = m(row, column);
    }
  }
  return out;
}

Eigen::Matrix3d matrix3(const Covariance3& c) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(c.data());
}

Covariance6 covariance6(const Eigen::Matrix3d& linear, const Eigen::Matrix3d& angular) {
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> all = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>::Zero();
  all.topLeftCorner<3, 3>() = linear;
  all.bottomRightCorner<3, 3>() = angular;
  Covariance6 out{};
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(out.data()) = all;
  return out;
}

Eigen::Matrix3d linear_block(const Covariance6& c) {
  return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(c.data()).topLeftCorner<3, 3>();
}

}  // namespace fathom::ros2
