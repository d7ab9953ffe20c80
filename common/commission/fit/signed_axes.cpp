#include "commission/fit/signed_axes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "geo/so3.hpp"

namespace fathom::commission {

using Eigen::Matrix3d;

const std::array<Matrix3d, 48>& signed_axes() {
  static const std::array<Matrix3d, 48> kAll = [] {
    std::array<Matrix3d, 48> all;
    std::array<int, 3> order{0, 1, 2};
    std::size_t n = 0;
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Matrix3d p = Matrix3d::Zero();
        for (int row = 0; row < 3; ++row)
          p(row, order[static_cast<std::size_t>(row)]) = (signs >> row & 1) != 0 ? -1.0 : 1.0;
        all[n++] = p;
      }
    } while (std::next_permutation(order.begin(), order.end()));
    return all;
  }();
  return kAll;
}

const Matrix3d& nearest_signed_axes(const Matrix3d& matrix) {
  return *std::max_element(signed_axes().begin(), signed_axes().end(),
                           [&](const Matrix3d& a, const Matrix3d& b) {
                             return (a.cwiseProduct(matrix)).sum() < (b.cwiseProduct(matrix)).sum();
                           });
}

std::string describe(const Matrix3d& P) {
  static constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  if (P.isIdentity(1e-9)) return {};
  if (P.isApprox(-Matrix3d::Identity(), 1e-9)) return "all three axes are negated";
  if (P.isDiagonal(1e-9)) {
    std::string axes;
    int count = 0;
    for (int i = 0; i < 3; ++i) {
      if (P(i, i) > 0.0) continue;
      axes += count++ == 0 ? kNames[static_cast<std::size_t>(i)]
                           : std::string(" and ") + kNames[static_cast<std::size_t>(i)];
    }
    if (count == 1) return axes + " is negated";
    const char* about = P(0, 0) > 0.0 ? "x" : P(1, 1) > 0.0 ? "y" : "z";
    return axes + " are negated, which is a turn by 180 degrees about " + about;
  }
  for (int i = 0; i < 3; ++i) {
    const int a = (i + 1) % 3;
    const int b = (i + 2) % 3;
    if (P(i, i) > 0.5 && P(a, b) > 0.5 && P(b, a) > 0.5) {
      return std::string(kNames[static_cast<std::size_t>(std::min(a, b))]) + " and " +
             kNames[static_cast<std::size_t>(std::max(a, b))] + " are exchanged";
    }
  }
  std::string rows;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (std::abs(P(row, column)) < 0.5) continue;
      rows += std::string(rows.empty() ? "" : ", ") + "the right " + kNames[static_cast<std::size_t>(row)] +
              " is " + (P(row, column) < 0.0 ? "minus " : "") + "the recorded " +
              kNames[static_cast<std::size_t>(column)];
    }
  }
  if (P.determinant() < 0.0) return "the axes are mirrored: " + rows;
  const Eigen::Vector3d rpy = geo::to_rpy(geo::from_matrix(P)) * (180.0 / M_PI);
  std::array<char, 96> turn{};
  std::snprintf(turn.data(), turn.size(),
                "the axes are turned by roll %.0f, pitch %.0f, yaw %.0f degrees: ", rpy.x(), rpy.y(),
                rpy.z());
  return turn.data() + rows;
}

Matrix3d best_rotation(const Matrix3d& sum_y_xT) {
  const Eigen::JacobiSVD<Matrix3d> svd(sum_y_xT, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d sign = Matrix3d::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * sign * svd.matrixV().transpose();
}

}  // namespace fathom::commission
