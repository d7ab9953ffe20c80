#include "geo/so3.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::geo {

Quaternion exp(const Eigen::Vector3d& rotation_rad) {
  const double square = 0.25 * rotation_rad.squaredNorm();
  double cosine = 0.0;
  double factor = 0.0;
  if (square < 1e-9) {
    // What more the series has is less than their rounding: such is the turn of N within a step.
    cosine = 1.0 - 0.5 * square;
    factor = 0.5 - square * (1.0 / 12.0);
  } else if (square < 0.01) {
    // Series in the square of the half angle, exact to rounding, and far from the quotient that would lose
    // digits at zero: the steps of a mechanisation are all of this kind.
    const auto term = [square](double divisor, double rest) { return 1.0 - square * (1.0 / divisor) * rest; };
    cosine = term(2.0, term(12.0, term(30.0, term(56.0, term(90.0, 1.0)))));
    factor = 0.5 * term(6.0, term(20.0, term(42.0, term(72.0, 1.0))));
  } else {
    const double half = std::sqrt(square);
    cosine = std::cos(half);
    factor = 0.5 * std::sin(half) / half;
  }
  return {cosine, factor * rotation_rad.x(), factor * rotation_rad.y(), factor * rotation_rad.z()};
}

Eigen::Vector3d log(const Quaternion& q) {
  const double sign = q.w < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d axis(q.x, q.y, q.z);
  const double sine = axis.norm();
  const double half = std::atan2(sine, sign * q.w);
  const double factor = sine < 1e-8 ? 2.0 / (sign * q.w) : 2.0 * half / sine;
  return sign * factor * axis;
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

Quaternion turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr double kOpposite = 1e-12;
  const Eigen::Vector3d a = from.normalized();
  const Eigen::Vector3d b = to.normalized();
  const double cosine = b.dot(a);
  if (cosine < -1.0 + kOpposite) {
    int least = 0;
    a.cwiseAbs().minCoeff(&least);
    const Eigen::Vector3d axis = cross(a, Eigen::Vector3d::Unit(least)).normalized();
    return {0.0, axis.x(), axis.y(), axis.z()};
  }
  const double twice_w = std::sqrt((1.0 + cosine) * 2.0);  // half-angle formula
  const Eigen::Vector3d v = cross(a, b) * (1.0 / twice_w);
  return {twice_w * 0.5, v.x(), v.y(), v.z()};
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
  const double level = std::sqrt(c(0, 0) * c(0, 0) + c(1, 0) * c(1, 0));
  const double pitch = std::atan2(-c(2, 0), level);
  if (level < 1e-9) return {0.0, pitch, std::atan2(-c(0, 1), c(1, 1))};
  return {std::atan2(c(2, 1), c(2, 2)), pitch, std::atan2(c(1, 0), c(0, 0))};
}

}  // namespace fathom::geo
