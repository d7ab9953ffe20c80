#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "geo/so3.hpp"
#include "ros2/messages/geometry.hpp"

/// All that turns axes between fathom and ROS 2. fathom: N north, east, down; B forward, right, down; q_NB
/// turns B into N. ROS 2: world axes W and body axes F of a convention; q_WF turns F into W.
namespace fathom::ros2 {

enum class Convention : std::uint8_t {
  enu_flu,  ///< REP-103: W east, north, up; F forward, left, up
  ned_frd   ///< W north, east, down; F forward, right, down
};

/// Turns a vector from N into W. Its own inverse in both conventions.
[[nodiscard]] Eigen::Matrix3d R_WN(Convention convention);
/// Turns a vector from B into F. Its own inverse in both conventions.
[[nodiscard]] Eigen::Matrix3d R_FB(Convention convention);

/// Of the same attitude; unit, w not negative.
[[nodiscard]] geo::Quaternion q_WF(Convention convention, const geo::Quaternion& q_NB);
[[nodiscard]] geo::Quaternion q_NB(Convention convention, const geo::Quaternion& q_WF);

/// The covariance of R v.
[[nodiscard]] inline Eigen::Matrix3d rotated(const Eigen::Matrix3d& R, const Eigen::Matrix3d& covariance) {
  return R * covariance * R.transpose();
}

/// The covariance (rad^2) of a small rotation of the body about the axes of N that goes with independent
/// standard deviations of roll, pitch and yaw (rad): roll is about the body's forward axis, pitch about the
/// horizontal one across the heading, yaw about down. First order.
[[nodiscard]] Eigen::Matrix3d rotation_covariance_N(const geo::Quaternion& q_NB,
                                                    const Eigen::Vector3d& rpy_sigma_rad);

/// Row-major, as messages have them.
[[nodiscard]] Covariance3 covariance3(const Eigen::Matrix3d& m);
[[nodiscard]] Eigen::Matrix3d matrix3(const Covariance3& c);
/// Two blocks that are not correlated: x, y, z, then the rotations.
[[nodiscard]] Covariance6 covariance6(const Eigen::Matrix3d& linear, const Eigen::Matrix3d& angular);
/// The block of x, y, z.
[[nodiscard]] Eigen::Matrix3d linear_block(const Covariance6& c);

[[nodiscard]] inline Vector3 vector3(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
[[nodiscard]] inline Point point(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
[[nodiscard]] inline Eigen::Vector3d eigen(const Vector3& v) {
  return {v.x, v.y, v.z};
}
[[nodiscard]] inline Quaternion quaternion(const geo::Quaternion& q) {
  return {q.x, q.y, q.z, q.w};
}
[[nodiscard]] inline geo::Quaternion hamilton(const Quaternion& q) {
  return {q.w, q.x, q.y, q.z};
}

}  // namespace fathom::ros2
