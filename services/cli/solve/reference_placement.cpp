#include "cli/solve/reference_placement.hpp"

#include <cmath>

#include <Eigen/Dense>

namespace fathom::cli {
namespace {

/// A second's worth of states says nothing about a clock.
constexpr std::size_t kLeastRows = 100;
/// Ratio of the eigenvalues of the normal matrix, its columns of one length, above which the five are not
/// told apart: a vehicle that keeps its speed has its clock error for an offset forward.
constexpr double kLargestCondition = 50.0;

// Clock, point forward and right, constant error north and east.
constexpr int kUnknowns = 5;
using Design = Eigen::Matrix<double, 2, kUnknowns>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Solution = Eigen::Matrix<double, kUnknowns, 1>;

}  // namespace

void ReferencePlacement::add(const NavState& state, const dataset::NavError& error) {
  Row row;
  row.error_N_m = {error.position_N_m[0], error.position_N_m[1]};
  row.velocity_N_m_s = {state.velocity_N_m_s[0], state.velocity_N_m_s[1]};
  row.heading = {std::cos(state.rpy_rad[2]), std::sin(state.rpy_rad[2])};
  const auto& p = state.position_covariance_N_m2;
  row.p_m2 = {p[0], p[1], p[4]};
  if (!known(row.error_N_m[0] + row.error_N_m[1] + row.velocity_N_m_s[0] + row.velocity_N_m_s[1] +
             row.heading[0] + p[0] + p[1] + p[4]))
    return;
  rows_.push_back(row);
}

Placement ReferencePlacement::figures() const {
  Placement out;
  out.count = rows_.size();
  if (rows_.size() < kLeastRows) return out;
  // error = v tau + C d + b
  const auto design = [](const Row& row) {
    Design a;
    a << row.velocity_N_m_s[0], row.heading[0], -row.heading[1], 1.0, 0.0,  //
        row.velocity_N_m_s[1], row.heading[1], row.heading[0], 0.0, 1.0;
    return a;
  };
  Normal normal = Normal::Zero();
  Solution right = Solution::Zero();
  for (const Row& row : rows_) {
    const Design a = design(row);
    normal += a.transpose() * a;
    right += a.transpose() * Eigen::Vector2d(row.error_N_m[0], row.error_N_m[1]);
  }
  const Solution scale = normal.diagonal().cwiseSqrt().cwiseMax(1e-12).cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Normal> parts(scale.asDiagonal() * normal * scale.asDiagonal());
  if (!(parts.eigenvalues()(0) * kLargestCondition > parts.eigenvalues()(kUnknowns - 1))) return out;
  const Solution found = normal.ldlt().solve(right);
  double sum2 = 0.0;
  double nees = 0.0;
  for (const Row& row : rows_) {
    const Eigen::Vector2d left =
        Eigen::Vector2d(row.error_N_m[0], row.error_N_m[1]) - design(row).leftCols<3>() * found.head<3>();
    Eigen::Matrix2d p;
    p << row.p_m2[0], row.p_m2[1], row.p_m2[1], row.p_m2[2];
    sum2 += left.squaredNorm();
    nees += left.dot(p.inverse() * left);
  }
  const auto count = static_cast<double>(rows_.size());
  out.reference_late_s = found(0);
  out.offset_B_m = {found(1), found(2)};
  out.rms_m = std::sqrt(sum2 / count);
  out.nees_horizontal = nees / count;
  return out;
}

}  // namespace fathom::cli
