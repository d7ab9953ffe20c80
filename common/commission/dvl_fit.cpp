#include "commission/dvl_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "commission/signed_axes.hpp"
#include "geo/so3.hpp"

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

constexpr double kApart_s = 0.9;
constexpr double kGap_s = 2.5;
constexpr double kMargin_s = 2.0;
constexpr int kLinear = 12;  // columns of M, lever
constexpr int kCommon = 19;  // and latency, bias of the rate, bias of the force
constexpr double kRateStep = 1e-4;
constexpr double kTimeStep_s = 0.02;

struct Unknowns {
  Matrix3d M = Matrix3d::Zero();
  Vector3d lever = Vector3d::Zero();
  double latency_s = 0.0;
  ImuReading reading;
  Vector3d force_bias = Vector3d::Zero();
};

// v at both ends in W, less what the unit felt between: zero but for gravity.
Vector3d excess(const Strapdown::State& a, const Strapdown::State& b, const Vector3d& va, const Vector3d& vb,
                const Unknowns& u) {
  return b.C_WB * (u.M * vb - b.rate.cross(u.lever)) - a.C_WB * (u.M * va - a.rate.cross(u.lever)) -
         (b.S - a.S) + (b.IC - a.IC) * u.force_bias;
}

struct Sums {
  WindowFit::Solution solution;
  std::vector<double> residuals;
};

Sums solve(const Series& series, const std::vector<Span>& windows, const Unknowns& u, bool full,
           double robust_scale) {
  const int count = full ? kCommon : kLinear;
  WindowFit fit(count);
  Sums sums;
  for (const Span& window : windows) {
    const double from_s = window.from_s - kMargin_s;
    const double to_s = window.to_s + kMargin_s;
    const Strapdown strapdown(series.imu, u.reading, from_s, to_s);
    std::vector<Strapdown> biased;
    for (int axis = 0; full && axis < 3; ++axis) {
      ImuReading other = u.reading;
      other.rate_bias[axis] += kRateStep;
      biased.emplace_back(series.imu, other, from_s, to_s);
    }
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (const auto& pair : pairs_in(series.dvl, window, kApart_s, kGap_s)) {
      const double from = series.dvl.t_s[pair.first] - u.latency_s;
      const double to = series.dvl.t_s[pair.second] - u.latency_s;
      if (strapdown.covers(from - 0.05) && strapdown.covers(to + 0.05)) pairs.push_back(pair);
    }
    if (pairs.size() < 3) continue;
    const auto rows = static_cast<Eigen::Index>(3 * pairs.size());
    MatrixXd J = MatrixXd::Zero(rows, count);
    MatrixXd Jw(rows, 3);
    VectorXd r(rows);
    std::vector<Vector3d> plain;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(3 * k);
      const Vector3d& va = series.dvl.v[pairs[k].first];
      const Vector3d& vb = series.dvl.v[pairs[k].second];
      const double from = series.dvl.t_s[pairs[k].first] - u.latency_s;
      const double to = series.dvl.t_s[pairs[k].second] - u.latency_s;
      const Strapdown::State a = strapdown.at(from);
      const Strapdown::State b = strapdown.at(to);
      const Vector3d residual = excess(a, b, va, vb, u);
      for (int column = 0; column < 3; ++column)
        J.block<3, 3>(at, 3 * column) = b.C_WB * vb[column] - a.C_WB * va[column];
      J.block<3, 3>(at, 9) = -b.C_WB * geo::skew(b.rate) + a.C_WB * geo::skew(a.rate);
      if (full) {
        const auto shifted = [&](double by) {
          return excess(strapdown.at(from - by), strapdown.at(to - by), va, vb, u);
        };
        J.block<3, 1>(at, 12) = (shifted(kTimeStep_s) - shifted(-kTimeStep_s)) / (2.0 * kTimeStep_s);
        for (int axis = 0; axis < 3; ++axis) {
          const Strapdown& other = biased[static_cast<std::size_t>(axis)];
          J.block<3, 1>(at, 13 + axis) =
              (excess(other.at(from), other.at(to), va, vb, u) - residual) / kRateStep;
        }
        J.block<3, 3>(at, 16) = b.IC - a.IC;
      }
      Jw.block<3, 3>(at, 0) = -(to - from) * Matrix3d::Identity();
      r.segment<3>(at) = residual;
    }
    // Robust by what is left beyond the window's own gravity.
    const Vector3d own = (Jw.transpose() * Jw).ldlt().solve(Jw.transpose() * r);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(3 * k);
      const double left = (r.segment<3>(at) - Jw.block<3, 3>(at, 0) * own).norm();
      sums.residuals.push_back(left);
      if (robust_scale <= 0.0 || left <= 3.0 * robust_scale) continue;
      const double weight = std::sqrt(3.0 * robust_scale / left);
      J.middleRows<3>(at) *= weight;
      Jw.middleRows<3>(at) *= weight;
      r.segment<3>(at) *= weight;
    }
    fit.add(J, Jw, r);
  }
  const double sigma = full && robust_scale > 0.0 ? robust_scale / 1.54 : 0.05;
  for (int i = 0; i < 3; ++i) fit.prior(9 + i, u.lever[i], 3.0, sigma);
  if (full) {
    for (int i = 0; i < 3; ++i) fit.prior(13 + i, u.reading.rate_bias[i], 0.01, sigma);
    for (int i = 0; i < 3; ++i) fit.prior(16 + i, u.force_bias[i], 0.2, sigma);
    fit.prior(12, 0.0, 0.5, sigma);
  }
  sums.solution = fit.solve();
  return sums;
}

void take(const WindowFit::Solution& solution, Unknowns& u) {
  for (int column = 0; column < 3; ++column) u.M.col(column) += solution.step.segment<3>(3 * column);
  u.lever += solution.step.segment<3>(9);
  if (solution.step.size() == kCommon) {
    u.latency_s += std::clamp(solution.step[12], -0.3, 0.3);
    u.reading.rate_bias += solution.step.segment<3>(13);
    u.force_bias += solution.step.segment<3>(16);
  }
}

DvlFit result(const WindowFit::Solution& solution, const Unknowns& u) {
  DvlFit out;
  out.done = solution.windows >= 2 && solution.step.allFinite();
  out.squares = solution.squares;
  out.freedom = solution.freedom;
  out.windows = solution.windows;
  out.M = u.M;
  out.M_covariance = solution.covariance.topLeftCorner<9, 9>();
  out.lever_B_m = u.lever;
  out.lever_sigma_m = solution.covariance.diagonal().segment<3>(9).cwiseSqrt();
  out.latency_s = u.latency_s;
  if (solution.step.size() == kCommon) out.latency_sigma_s = std::sqrt(solution.covariance(12, 12));
  return out;
}

}  // namespace

DvlFit fit_dvl_linear(const Series& series, const std::vector<Span>& windows, const ImuReading& reading,
                      double latency_s) {
  Unknowns u;
  u.reading = reading;
  u.latency_s = latency_s;
  const Sums sums = solve(series, windows, u, false, 0.0);
  take(sums.solution, u);
  return result(sums.solution, u);
}

DvlFit fit_dvl(const Series& series, const std::vector<Span>& windows, const ImuReading& reading,
               double latency_s) {
  Unknowns u;
  u.reading = reading;
  u.latency_s = latency_s;
  take(solve(series, windows, u, false, 0.0).solution, u);
  double scale = 0.0;
  DvlFit out;
  for (int iteration = 0; iteration < 6; ++iteration) {
    const Sums sums = solve(series, windows, u, true, scale);
    if (sums.residuals.size() < 12) return out;
    scale = std::max(1e-4, median(sums.residuals));
    take(sums.solution, u);
    out = result(sums.solution, u);
  }
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
