#include "geo/so3.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::geo {

Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Quaternion conjugate(const Quaternion& q) {
  return {q.w, -q.x, -q.y, -q.z};
}

Quaternion normalized(const Quaternion& q) {
  const double scale = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
}

Quaternion exp(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  const double half = 0.5 * angle;
  // sin(x)/x to rounding where the quotient would lose digits.
  const double factor = angle < 1e-4 ? 0.5 * (1.0 - half * half / 6.0) : std::sin(half) / angle;
  return {std::cos(half), factor * rotation_rad.x(), factor * rotation_rad.y(), factor * rotation_rad.z()};
}

Eigen::Vector3d log(const Quaternion& q) {
  const double sign = q.w < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d axis(q.x, q.y, q.z);
  const double sine = axis.norm();
  const double half = std::atan2(sine, sign * q.w);
  const double factor = sine < 1e-8 ? 2.0 / (sign * q.w) : 2.0 * half / sine;
  return sign * factor * axis;
}

Eigen::Matrix3d to_matrix(const Quaternion& q) {
  Eigen::Matrix3d c;
  c << 1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y - q.w * q.z), 2.0 * (q.x * q.z + q.w * q.y),
      2.0 * (q.x * q.y + q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z - q.w * q.x),
      2.0 * (q.x * q.z - q.w * q.y), 2.0 * (q.y * q.z + q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y);
  return c;
}

Quaternion from_matrix(const Eigen::Matrix3d& c) {
  // Shepperd: take the largest of the four squares first, so that nothing small is divided by.
  const double trace = c.trace();
  const std::array<double, 4> squares{1.0 + trace, 1.0 + 2.0 * c(0, 0) - trace, 1.0 + 2.0 * c(1, 1) - trace,
                                      1.0 + 2.0 * c(2, 2) - trace};
  const auto largest = std::max_element(squares.begin(), squares.end()) - squares.begin();
  const double r = std::sqrt(squares[static_cast<std::size_t>(largest)]);
  const double s = 0.5 / r;
  Quaternion q;
  switch (largest) {
    case 0:
      q = {0.5 * r, s * (c(2, 1) - c(1, 2)), s * (c(0, 2) - c(2, 0)), s * (c(1, 0) - c(0, 1))};
      break;
    case 1:
      q = {s * (c(2, 1) - c(1, 2)), 0.5 * r, s * (c(0, 1) + c(1, 0)), s * (c(0, 2) + c(2, 0))};
      break;
    case 2:
      q = {s * (c(0, 2) - c(2, 0)), s * (c(0, 1) + c(1, 0)), 0.5 * r, s * (c(1, 2) + c(2, 1))};
      break;
    default:
      q = {s * (c(1, 0) - c(0, 1)), s * (c(0, 2) + c(2, 0)), s * (c(1, 2) + c(2, 1)), 0.5 * r};
      break;
  }
  if (q.w < 0.0) q = {-q.w, -q.x, -q.y, -q.z};
  return normalized(q);
}

Quaternion from_rpy(const Eigen::Vector3d& rpy_rad) {
  const double cr = std::cos(0.5 * rpy_rad.x());
  const double sr = std::sin(0.5 * rpy_rad.x());
  const double cp = std::cos(0.5 * rpy_rad.y());
  const double sp = std::sin(0.5 * rpy_rad.y());
  const double cy = std::cos(0.5 * rpy_rad.z());
  const double sy = std::sin(0.5 * rpy_rad.z());
  return {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
          cr * cp * sy - sr * sp * cy};
}

Eigen::Vector3d to_rpy(const Quaternion& q) {
  const Eigen::Matrix3d c = to_matrix(q);
  const double level = std::hypot(c(0, 0), c(1, 0));
  const double pitch = std::atan2(-c(2, 0), level);
  if (level < 1e-9) return {0.0, pitch, std::atan2(-c(0, 1), c(1, 1))};
  return {std::atan2(c(2, 1), c(2, 2)), pitch, std::atan2(c(1, 0), c(0, 0))};
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Vector3d cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

}  // namespace fathom::geo
