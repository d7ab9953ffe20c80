#pragma once

#include <array>

#include <Eigen/Core>

/// Rotations. A quaternion is Hamilton, w first; q_AB and C_AB turn vectors from B into A.
/// Euler angles are roll, pitch, yaw of the sequence yaw-pitch-roll (ZYX), rad.
namespace fathom::geo {

struct Quaternion {
  double w = 1.0;
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

/// The Hamilton product: q_AC = q_AB * q_BC.
[[nodiscard]] Quaternion operator*(const Quaternion& a, const Quaternion& b);
[[nodiscard]] Quaternion conjugate(const Quaternion& q);
/// Of unit length, same rotation.
[[nodiscard]] Quaternion normalized(const Quaternion& q);

/// The quaternion of a rotation vector; exact to rounding for any length, zero included.
[[nodiscard]] Quaternion exp(const Eigen::Vector3d& rotation_rad);
/// The shortest rotation vector of a unit quaternion.
[[nodiscard]] Eigen::Vector3d log(const Quaternion& q);

[[nodiscard]] Eigen::Matrix3d to_matrix(const Quaternion& q);
[[nodiscard]] Quaternion from_matrix(const Eigen::Matrix3d& rotation);
[[nodiscard]] Quaternion from_rpy(const Eigen::Vector3d& rpy_rad);
/// Pitch in [-pi/2, pi/2], roll and yaw in (-pi, pi]. At a pitch of a right angle roll is 0.
[[nodiscard]] Eigen::Vector3d to_rpy(const Quaternion& q);

/// [v x]: skew(a) * b is the cross product of a and b.
[[nodiscard]] Eigen::Matrix3d skew(const Eigen::Vector3d& v);
[[nodiscard]] Eigen::Vector3d cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

[[nodiscard]] inline Eigen::Vector3d vec(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}
[[nodiscard]] inline std::array<double, 3> arr(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace fathom::geo
