#include "commission/fit/gps_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/median.hpp"
#include "base/units.hpp"
#include "commission/fit/latency.hpp"
#include "commission/fit/reject.hpp"
#include "commission/fit/signed_axes.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kGpsApart_s = 0.4;
constexpr double kGpsGap_s = 2.5;
// Receivers that are quicker filter: what they add is not independent.
constexpr double kLeastFixStep_s = 0.15;
// What the turn of the Earth, which is not modelled here, adds within a window: quieter residuals decide
// nothing.
constexpr double kGpsModel_m_s = 0.015;
// Of the heading of a window, from which it is told from that of the next quarter of a turn.
const double kHeadingSigma_rad = 0.25 * std::numbers::pi / std::sqrt(2.0 * kReject);
constexpr double kLeastDirections = 3.0;
constexpr double kCompassGap_s = 3.0;

double gravity_of(const Series& series) {
  return known(series.latitude_rad) ? geo::gravity(series.latitude_rad, 0.0) : kStandardGravity_m_s2;
}

Vector3d mean_of(const std::vector<Vector3d>& some) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& each : some) sum += each;
  return sum / static_cast<double>(some.size());
}

// What the unit felt up to an instant and the turning of the lever, in W.
Vector3d felt(const Strapdown::State& state, const Vector3d& lever) {
  return state.S + state.C_WB * state.rate.cross(lever);
}

// Least squares with the worst residuals counting less.
double robust_weight(double residual, double scale) {
  const double limit = 3.0 * scale;
  return residual <= limit ? 1.0 : limit / residual;
}

// The mean of directions that have weights.
struct Directions {
  Vector3d sum = Vector3d::Zero();
  double weight = 0.0;
  double weight2 = 0.0;
  void add(const Vector3d& direction, double its_weight) {
    sum += direction;
    weight += its_weight;
    weight2 += its_weight * its_weight;
  }
  [[nodiscard]] double count() const { return weight2 > 0.0 ? weight * weight / weight2 : 0.0; }
  [[nodiscard]] double scatter() const { return std::max(1e-6, 1.0 - sum.norm() / weight); }
  // Of many small angles the mean square is twice the scatter.
  [[nodiscard]] Ahead mean() const { return {sum / weight, std::sqrt(2.0 * scatter() / count())}; }
};

// What a window says of the directions of the vehicle and of its compass.
struct WindowTurn {
  Span span;
  Matrix3d C_NW = Matrix3d::Zero();  // zero: there are too few rows
  double change2 = 0.0;              // of the velocity over ground, squares
  double felt2 = 0.0;                // of the horizontal change that the inertial unit felt, squares
};

// A window without starts, stops and turns does not tell which way the vehicle points: it does not count.
void find_ahead(const Series& series, const GpsVelocity& velocity_N, const std::vector<WindowTurn>& windows,
                const ImuReading& reading, double sigma_m_s, GpsFit& out) {
  Directions in_body;
  Directions over_ground;
  Directions of_compass;
  for (const WindowTurn& window : windows) {
    if (!(std::sqrt(window.felt2) * kHeadingSigma_rad > sigma_m_s)) continue;
    const Strapdown strapdown(series.imu, reading, window.span.from_s - kWindowMargin_s,
                              window.span.to_s + kWindowMargin_s);
    Vector3d gone_B = Vector3d::Zero();
    Vector3d gone_N = Vector3d::Zero();
    Vector3d compass_B = Vector3d::Zero();
    double length = 0.0;
    double read = 0.0;
    for (const auto& [i, j] : pairs_in(velocity_N, window.span, kGpsApart_s, kGpsGap_s)) {
      const double t = velocity_N.t_s[i] - out.latency_s;
      if (!strapdown.covers(t)) continue;
      const Matrix3d C_BN = (window.C_NW * strapdown.at(t).C_WB).transpose();
      gone_B += C_BN * velocity_N.v[i];
      gone_N += velocity_N.v[i];
      length += velocity_N.v[i].norm();
      const auto heading = at(series.heading, t, kCompassGap_s);
      if (!heading) continue;
      compass_B += C_BN * Vector3d(std::cos(*heading), std::sin(*heading), 0.0);
      read += 1.0;
    }
    if (length > 0.0) {
      in_body.add(gone_B, length);
      over_ground.add(gone_N, length);
    }
    if (read > 0.0) of_compass.add(compass_B / read, 1.0);
  }
  if (of_compass.count() >= kLeastDirections) out.compass = of_compass.mean();
  if (in_body.count() < kLeastDirections) return;
  // What sways a vehicle lasts: a window counts once. One course over ground says nothing of a bow, nor do
  // many of a multicopter that keeps its heading where it likes.
  const double has_bow = 0.5 * (in_body.count() - 1.0) * std::log(over_ground.scatter() / in_body.scatter());
  if (has_bow > kReject) out.way = in_body.mean();
}

}  // namespace

GpsSquares gps_squares(const Series& series, const GpsVelocity& velocity_N, const std::vector<Span>& windows,
                       const ImuReading& reading, double latency_s, double enough) {
  const Vector3d gravity(0.0, 0.0, gravity_of(series));
  GpsSquares squares;
  for (const Span& window : windows) {
    if (squares.as_read > enough && squares.force_negated > enough) break;
    const Strapdown strapdown(series.imu, reading, window.from_s - kWindowMargin_s,
                              window.to_s + kWindowMargin_s);
    std::vector<Vector3d> x;
    std::vector<Vector3d> y;
    for (const std::size_t i : rows_in(velocity_N, window, kLeastFixStep_s)) {
      const double t = velocity_N.t_s[i] - latency_s;
      if (!strapdown.covers(t)) continue;
      x.push_back(strapdown.at(t).S);
      y.push_back(velocity_N.v[i] - gravity * (t - window.from_s));
    }
    if (x.size() < 5) continue;
    const Vector3d mean_x = mean_of(x);
    const Vector3d mean_y = mean_of(y);
    Matrix3d sum = Matrix3d::Zero();
    for (std::size_t k = 0; k < x.size(); ++k) sum += (y[k] - mean_y) * (x[k] - mean_x).transpose();
    const Matrix3d R = best_rotation(sum);
    const Matrix3d R_negated = best_rotation(-sum);
    const double of_model =
        velocity_N.known_axes() * static_cast<double>(x.size()) * kGpsModel_m_s * kGpsModel_m_s;
    squares.as_read += of_model;
    squares.force_negated += of_model;
    for (std::size_t k = 0; k < x.size(); ++k) {
      squares.as_read += velocity_N.measured(y[k] - mean_y - R * (x[k] - mean_x)).squaredNorm();
      squares.force_negated += velocity_N.measured(y[k] - mean_y + R_negated * (x[k] - mean_x)).squaredNorm();
    }
  }
  return squares;
}

GpsFit fit_gps(const Series& series, const GpsVelocity& velocity_N, const std::vector<Span>& windows,
               const ImuReading& reading, double latency_s, const Vector3d& lever_B_m) {
  GpsFit out;
  out.latency_s = latency_s;
  out.lever_B_m = lever_B_m;
  const Vector3d gravity(0.0, 0.0, gravity_of(series));
  // Gravity, which is far larger than what the vertical velocity adds, holds the turn of a window also where
  // that is unknown; its rows then say nothing.
  const int axes = velocity_N.known_axes();
  constexpr int kCommon = 10;  // lever, latency, bias of the rate, bias of the force
  ImuReading now = reading;
  Vector3d force_bias = Vector3d::Zero();
  double scale = 1.0;
  constexpr double kTimeStep_s = 0.02;
  double residual_sigma = 0.0;
  std::vector<WindowTurn> turns(windows.size());
  for (int iteration = 0; iteration < 6; ++iteration) {
    WindowFit fit(kCommon);
    std::vector<double> residuals;
    for (std::size_t w = 0; w < windows.size(); ++w) {
      const double from_s = windows[w].from_s - kWindowMargin_s;
      const double to_s = windows[w].to_s + kWindowMargin_s;
      const Strapdown strapdown(series.imu, now, from_s, to_s, Strapdown::Integrate::motion_and_biases);
      // Points of the window: v = v0 + R x + g t, v0 and R of the window.
      const double begin_s = windows[w].from_s;
      std::vector<double> times;
      std::vector<Vector3d> x;
      std::vector<Vector3d> y;
      Vector3d mean_x = Vector3d::Zero();
      Vector3d mean_y = Vector3d::Zero();
      for (const std::size_t i : rows_in(velocity_N, windows[w], kLeastFixStep_s)) {
        const double t = velocity_N.t_s[i] - out.latency_s;
        if (!strapdown.covers(t - 0.05) || !strapdown.covers(t + 0.05)) continue;
        times.push_back(t);
        const auto [state, of_bias] = strapdown.both_at(t);
        x.push_back(felt(state, out.lever_B_m) - of_bias.IC * force_bias);
        y.push_back(velocity_N.v[i] - gravity * (t - begin_s));
        mean_x += x.back();
        mean_y += y.back();
      }
      if (x.size() < 5) continue;
      mean_x /= static_cast<double>(x.size());
      mean_y /= static_cast<double>(x.size());
      Matrix3d sum = Matrix3d::Zero();
      for (std::size_t k = 0; k < x.size(); ++k) sum += (y[k] - mean_y) * (x[k] - mean_x).transpose();
      const Matrix3d R = best_rotation(sum);
      turns[w] = {windows[w], R};
      for (std::size_t k = 0; k < x.size(); ++k) {
        turns[w].change2 += (y[k] - mean_y).head<2>().squaredNorm();
        turns[w].felt2 += (R * (x[k] - mean_x)).head<2>().squaredNorm();
      }
      const Eigen::Index rows = axes * static_cast<Eigen::Index>(x.size());
      MatrixXd J(rows, kCommon);
      MatrixXd Jw(rows, 6);
      VectorXd r(rows);
      for (std::size_t k = 0; k < x.size(); ++k) {
        const Eigen::Index at = axes * static_cast<Eigen::Index>(k);
        const double t = times[k];
        const auto [state, of_bias] = strapdown.both_at(t);
        const Vector3d residual = y[k] - mean_y - R * (x[k] - mean_x);
        const double size = velocity_N.measured(residual).norm();
        residuals.push_back(size);
        const double weight = std::sqrt(robust_weight(size, scale));
        MatrixXd row(3, kCommon);
        row.block<3, 3>(0, 0) = -R * state.C_WB * geo::skew(state.rate);
        // The stamp moves gravity's part of y as well.
        row.col(3) = gravity - R *
                                   (felt(strapdown.at(t - kTimeStep_s), out.lever_B_m) -
                                    felt(strapdown.at(t + kTimeStep_s), out.lever_B_m)) /
                                   (2.0 * kTimeStep_s);
        const Vector3d swing_W = state.C_WB * state.rate.cross(out.lever_B_m);
        row.block<3, 3>(0, 4) =
            -R * (of_bias.IFC + geo::skew(swing_W) * of_bias.IC + state.C_WB * geo::skew(out.lever_B_m)) *
            now.rate;
        row.block<3, 3>(0, 7) = R * of_bias.IC;
        const Matrix3d by_turn = geo::skew(R * (x[k] - mean_x));
        J.middleRows(at, axes) = weight * row.topRows(axes);
        Jw.block(at, 0, axes, 3) = weight * by_turn.topRows(axes);
        Jw.block(at, 3, axes, 3) = -weight * Matrix3d::Identity().topRows(axes);
        r.segment(at, axes) = weight * residual.head(axes);
      }
      fit.add(J, Jw, r);
    }
    if (residuals.size() < 12) return out;
    scale = std::max(1e-4, median(residuals));
    // Over the median of the length of three normal numbers, or of two.
    residual_sigma = scale / (axes == 3 ? 1.54 : 1.18);
    for (int i = 0; i < 3; ++i) fit.prior(i, out.lever_B_m[i] - lever_B_m[i], 3.0, residual_sigma);
    fit.prior(3, out.latency_s - latency_s, 0.5, residual_sigma);
    for (int i = 0; i < 3; ++i)
      fit.prior(4 + i, now.rate_bias[i] - reading.rate_bias[i], 0.03, residual_sigma);
    for (int i = 0; i < 3; ++i) fit.prior(7 + i, force_bias[i], 0.5, residual_sigma);
    const WindowFit::Solution solution = fit.solve();
    const double most_s = 0.3;
    out.lever_B_m += solution.step.segment<3>(0);
    out.latency_s += std::clamp(solution.step[3], -most_s, most_s);
    now.rate_bias += solution.step.segment<3>(4);
    force_bias += solution.step.segment<3>(7);
    out.lever_sigma_m = solution.covariance.diagonal().segment<3>(0).cwiseSqrt();
    out.latency_sigma_s = std::sqrt(solution.covariance(3, 3));
    out.rate_bias_sigma = solution.covariance.diagonal().segment<3>(4).cwiseSqrt();
    out.residual_m_s = std::sqrt(solution.squares / solution.freedom);
    out.windows = solution.windows;
  }
  out.rate_bias = now.rate_bias - reading.rate_bias;
  out.done = true;
  double most = 0.0;
  for (const WindowTurn& turn : turns) {
    if (turn.C_NW.isZero() || turn.change2 <= most) continue;
    const Strapdown strapdown(series.imu, now, turn.span.from_s - kWindowMargin_s,
                              turn.span.to_s + kWindowMargin_s);
    if (!strapdown.covers(turn.span.from_s)) continue;
    most = turn.change2;
    out.attitude = AttitudeAt{turn.span.from_s, turn.C_NW * strapdown.at(turn.span.from_s).C_WB};
  }
  find_ahead(series, velocity_N, turns, now, residual_sigma, out);
  return out;
}

}  // namespace fathom::commission
