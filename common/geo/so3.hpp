#pragma once

#include <array>
#include <cmath>

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

// The short ones stand here so that the estimator's loops take them in.

/// The Hamilton product: q_AC = q_AB * q_BC.
[[nodiscard]] inline Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
[[nodiscard]] inline Quaternion conjugate(const Quaternion& q) {
  return {q.w, -q.x, -q.y, -q.z};
}
/// Of unit length, same rotation.
[[nodiscard]] inline Quaternion normalized(const Quaternion& q) {
  const double scale = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
}

/// The quaternion of a rotation vector; exact to rounding for any length, zero included.
[[nodiscard]] Quaternion exp(const Eigen::Vector3d& rotation_rad);
/// The shortest rotation vector of a unit quaternion.
[[nodiscard]] Eigen::Vector3d log(const Quaternion& q);

[[nodiscard]] inline Eigen::Matrix3d to_matrix(const Quaternion& q) {
  Eigen::Matrix3d c;
  c << 1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y - q.w * q.z), 2.0 * (q.x * q.z + q.w * q.y),
      2.0 * (q.x * q.y + q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z - q.w * q.x),
      2.0 * (q.x * q.z - q.w * q.y), 2.0 * (q.y * q.z + q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y);
  return c;
}
[[nodiscard]] Quaternion from_matrix(const Eigen::Matrix3d& rotation);
/// The shortest turn of one direction into another; of opposite ones half a turn about an axis across them.
/// Neither vector is zero.
[[nodiscard]] Quaternion turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
[[nodiscard]] Quaternion from_rpy(const Eigen::Vector3d& rpy_rad);
/// Pitch in [-pi/2, pi/2], roll and yaw in (-pi, pi]. At a pitch of a right angle roll is 0.
[[nodiscard]] Eigen::Vector3d to_rpy(const Quaternion& q);

/// [v x]: skew(a) * b is the cross product of a and b.
[[nodiscard]] inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}
[[nodiscard]] inline Eigen::Vector3d cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

[[nodiscard]] inline Eigen::Vector3d vec(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}
[[nodiscard]] inline std::array<double, 3> arr(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace fathom::geo
