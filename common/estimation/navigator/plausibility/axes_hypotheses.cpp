#include "estimation/navigator/plausibility/axes_hypotheses.hpp"

#include <algorithm>
#include <array>

#include "geo/so3.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d rows(const Vector3d& x, const Vector3d& y, const Vector3d& z) {
  Matrix3d out;
  out << x.transpose(), y.transpose(), z.transpose();
  return out;
}

}  // namespace

const AxesHypothesis& axes_hypothesis(std::size_t number) {
  static const auto kAll = [] {
    const Vector3d x = Vector3d::UnitX();
    const Vector3d y = Vector3d::UnitY();
    const Vector3d z = Vector3d::UnitZ();
    const Matrix3d same = Matrix3d::Identity();
    // An exchange of accelerometer axes mirrors: it looks like the negated exchange of the gyro's.
    return std::array<AxesHypothesis, kAxesHypotheses>{
        {{rows(x, y, z), "", same},
         {rows(y, x, z), "exchange gyro x and y", same},
         {rows(z, y, x), "exchange gyro x and z", same},
         {rows(x, z, y), "exchange gyro y and z", same},
         {rows(-x, -y, -z), "negate gyro x, y and z", same},
         {rows(-x, y, z), "negate gyro x", same},
         {rows(x, -y, z), "negate gyro y", same},
         {rows(x, y, -z), "negate gyro z", same},
         {rows(-x, -y, z), "negate gyro x and y, or accelerometer z", same},
         {rows(-y, -x, -z), "exchange accelerometer x and y", rows(y, x, z)},
         {rows(-z, -y, -x), "exchange accelerometer x and z", rows(z, y, x)},
         {rows(x, -y, -z), "negate accelerometer x, or gyro y and z", rows(-x, y, z)},
         {rows(-x, y, -z), "negate accelerometer y, or gyro x and z", rows(x, -y, z)}}};
  }();
  return kAll[std::min(number, kAxesHypotheses - 1)];
}

Vector3d turned_down(const Vector3d& turn_rad, const Vector3d& down) {
  return geo::to_matrix(geo::exp(-turn_rad)) * down;
}

}  // namespace fathom::estimation
