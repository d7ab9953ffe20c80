#include "commission/fit/dvl_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "commission/fit/latency.hpp"
#include "commission/fit/signed_axes.hpp"
#include "geo/so3.hpp"

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

constexpr double kDvlApart_s = 0.9;
constexpr double kDvlGap_s = 2.5;
// What the turn of the Earth, which is not modelled here, adds between two rows: quieter residuals decide
// nothing.
constexpr double kDvlModel_m_s = 0.005;
constexpr int kLinear = 12;          // columns of M, lever
constexpr double kSigma_m_s = 0.05;  // beside which the lever's prior of 3 m is nothing

}  // namespace

DvlFit fit_dvl_linear(const Series& series, const std::vector<Span>& windows, const ImuReading& reading,
                      double latency_s) {
  WindowFit fit(kLinear);
  for (const Span& window : windows) {
    const Strapdown strapdown(series.imu, reading, window.from_s - kWindowMargin_s,
                              window.to_s + kWindowMargin_s);
    std::vector<MatrixXd> blocks;
    std::vector<Vector3d> felt;
    std::vector<double> spans;
    for (const auto& [i, j] : pairs_in(series.dvl, window, kDvlApart_s, kDvlGap_s)) {
      const double from = series.dvl.t_s[i] - latency_s;
      const double to = series.dvl.t_s[j] - latency_s;
      if (!strapdown.covers(from) || !strapdown.covers(to)) continue;
      const Strapdown::State a = strapdown.at(from);
      const Strapdown::State b = strapdown.at(to);
      MatrixXd block(3, kLinear);
      for (int column = 0; column < 3; ++column)
        block.middleCols<3>(3 * column) = b.C_WB * series.dvl.v[j][column] - a.C_WB * series.dvl.v[i][column];
      block.middleCols<3>(9) = -b.C_WB * geo::skew(b.rate) + a.C_WB * geo::skew(a.rate);
      blocks.push_back(block);
      felt.push_back(b.S - a.S);
      spans.push_back(to - from);
    }
    if (blocks.size() < 3) continue;
    const auto rows = static_cast<Eigen::Index>(3 * blocks.size());
    MatrixXd J(rows, kLinear);
    MatrixXd Jw(rows, 3);
    VectorXd r(rows);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(3 * k);
      J.middleRows<3>(at) = blocks[k];
      Jw.middleRows<3>(at) = -spans[k] * Matrix3d::Identity();
      r.segment<3>(at) = -felt[k];
    }
    fit.add(J, Jw, r);
  }
  for (int i = 0; i < 3; ++i) fit.prior(9 + i, 0.0, 3.0, kSigma_m_s);
  const WindowFit::Solution solution = fit.solve();
  DvlFit out;
  out.done = solution.windows >= 2 && solution.step.allFinite();
  out.squares = solution.squares + solution.freedom * kDvlModel_m_s * kDvlModel_m_s;
  out.freedom = solution.freedom;
  out.windows = solution.windows;
  for (int column = 0; column < 3; ++column) out.M.col(column) = solution.step.segment<3>(3 * column);
  out.M_covariance = solution.covariance.topLeftCorner<9, 9>();
  out.lever_B_m = solution.step.segment<3>(9);
  out.lever_sigma_m = solution.covariance.diagonal().segment<3>(9).cwiseSqrt();
  return out;
}

Similarity fit_similarity(const DvlFit& fit, bool mirrored) {
  Matrix3d D = Matrix3d::Identity();
  if (mirrored) D(1, 1) = -1.0;
  // What the log does not tell about M must not decide: a little more covariance keeps its inverse finite.
  Matrix9d covariance = fit.M_covariance;
  covariance.diagonal().array() += 1e-10;
  const Matrix9d information = covariance.ldlt().solve(Matrix9d::Identity());
  const auto vec9 = [](const Matrix3d& m) { return Vector9d(Eigen::Map<const Vector9d>(m.data())); };
  const Vector9d measured = vec9(fit.M);
  Similarity best;
  best.chi2 = 1e300;
  for (const Matrix3d& P : signed_axes()) {
    if (P.determinant() < 0.0) continue;
    Similarity now;
    now.mirrored = mirrored;
    now.C = P;
    const Vector9d shape = vec9(P * D);
    now.scale = shape.dot(information * measured) / shape.dot(information * shape);
    if (!(now.scale > 0.0)) continue;
    for (int iteration = 0; iteration < 25; ++iteration) {
      Eigen::Matrix<double, 9, 4> J;
      for (int axis = 0; axis < 3; ++axis)
        J.col(axis) = vec9(now.scale * now.C * geo::skew(Vector3d::Unit(axis)) * D);
      J.col(3) = vec9(now.C * D);
      const Vector9d r = measured - vec9(now.scale * now.C * D);
      const Eigen::Matrix4d N = J.transpose() * information * J;
      Eigen::Vector4d step = N.ldlt().solve(J.transpose() * information * r);
      const double turn = step.head<3>().norm();
      if (turn > 0.5) step.head<3>() *= 0.5 / turn;
      now.C = now.C * geo::to_matrix(geo::exp(Vector3d(step.head<3>())));
      now.scale = std::max(1e-9, now.scale + step[3]);
      const Eigen::Matrix4d inverse = N.ldlt().solve(Eigen::Matrix4d::Identity());
      now.turn_sigma_rad = inverse.diagonal().head<3>().cwiseMax(0.0).cwiseSqrt();
      now.scale_sigma = std::sqrt(std::max(0.0, inverse(3, 3)));
      if (step.norm() < 1e-10) break;
    }
    const Vector9d r = measured - vec9(now.scale * now.C * D);
    now.chi2 = r.dot(information * r);
    // Equal fits: the one that needs the smaller turn.
    const auto turn = [](const Similarity& s) {
      return std::acos(std::clamp((s.C.trace() - 1.0) / 2.0, -1.0, 1.0));
    };
    if (now.chi2 < best.chi2 - 4.0 || (now.chi2 < best.chi2 + 4.0 && turn(now) < turn(best) - 1e-6))
      best = now;
  }
  return best;
}

}  // namespace fathom::commission
