#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "base/median.hpp"
#include "commission/fit/dvl_fit.hpp"
#include "commission/fit/latency.hpp"
#include "geo/so3.hpp"

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kLeastDvlStep_s = 0.15;
constexpr double kTimeStep_s = 0.02;
constexpr double kSettled = 1e-2;      // of a sigma: a step that changes nothing
constexpr double kMostTurn_rad = 0.3;  // of a step
constexpr double kHeld_rad = 1e-6;     // sigma of a turn that is held
// Half a turn takes eleven of the longest; as many again for what else has to come along, and some to settle.
constexpr int kMostSteps = 30;
// Unknowns: turn of the mounting, log of the scale, lever, latency, bias of the rate, bias of the force.
constexpr int kTurn = 0, kScale = 3, kLever = 4, kLatency = 7, kRateBias = 8, kForceBias = 11, kCommon = 14;

struct Unknowns {
  Matrix3d C;
  Matrix3d D = Matrix3d::Identity();
  double scale = 1.0;
  Vector3d lever;
  double latency_s = 0.0;
  ImuReading reading;
  Vector3d force_bias = Vector3d::Zero();
};

// A window's own: velocity at its start, gravity, and the drift of gravity in the frame of the gyro as the
// Earth turns.
using Own = Eigen::Matrix<double, 9, 1>;
constexpr double kDrift_m_s3 = 7.292e-5 * 9.8;  // one sigma of each component of the drift

// The integration at an instant.
struct At {
  At(const MovedStrapdown& strapdown, double at_s) : t_s(at_s), there(strapdown.at(at_s)) {}
  double t_s;
  Strapdown::Both there;
};

// A window's rows: what the DVL read, when.
struct Row {
  Vector3d read;
  At at;
};

// Velocity in body axes of the DVL's place.
Vector3d body_velocity(const At& at, double begin_s, const Unknowns& u, const Own& own) {
  const auto& [t_s, there] = at;
  const auto& [state, of_bias] = there;
  const Vector3d v_W = own.head<3>() + state.S - of_bias.IC * u.force_bias +
                       own.segment<3>(3) * (t_s - begin_s) +
                       own.tail<3>() * (0.5 * (t_s - begin_s) * (t_s - begin_s));
  return state.C_WB.transpose() * v_W + state.rate.cross(u.lever);
}

double weight_of(double residual, double scale) {
  return scale <= 0.0 || residual <= 3.0 * scale ? 1.0 : std::sqrt(3.0 * scale / residual);
}

void add_window(const Series& series, const Span& window, const MovedStrapdown& strapdown, const Unknowns& u,
                double robust_scale, WindowFit& fit, std::vector<double>& residuals) {
  std::vector<Row> rows;
  for (const std::size_t i : rows_in(series.dvl, window, kLeastDvlStep_s)) {
    const double t = series.dvl.t_s[i] - u.latency_s;
    if (!strapdown.covers(t - 0.05) || !strapdown.covers(t + 0.05)) continue;
    rows.push_back({series.dvl.v[i], At(strapdown, t)});
  }
  if (rows.size() < 6) return;
  const double begin_s = window.from_s;
  const Matrix3d A = u.D * u.C.transpose() / u.scale;
  const auto count = static_cast<Eigen::Index>(3 * rows.size());
  const double drift_weight = (robust_scale > 0.0 ? robust_scale / 1.54 : 0.01) / kDrift_m_s3;
  // The window's own velocity and gravity for the present common unknowns: linear.
  MatrixXd Jw = MatrixXd::Zero(count + 3, 9);
  VectorXd r = VectorXd::Zero(count + 3);
  Own own = Own::Zero();
  Jw.bottomRightCorner<3, 3>() = drift_weight * Matrix3d::Identity();
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(3 * k);
      const double t = rows[k].at.t_s;
      const Matrix3d turn = A * rows[k].at.there.state.C_WB.transpose();
      const Vector3d residual = rows[k].read - A * body_velocity(rows[k].at, begin_s, u, own);
      const double weight = pass == 0 ? 1.0 : weight_of(residual.norm(), robust_scale);
      Jw.block<3, 3>(at, 0) = -weight * turn;
      Jw.block<3, 3>(at, 3) = -weight * (t - begin_s) * turn;
      Jw.block<3, 3>(at, 6) = -weight * 0.5 * (t - begin_s) * (t - begin_s) * turn;
      r.segment<3>(at) = weight * residual;
    }
    r.tail<3>() = drift_weight * own.tail<3>();
    own -= (Jw.transpose() * Jw + 1e-9 * MatrixXd::Identity(9, 9)).ldlt().solve(Jw.transpose() * r);
  }
  r.tail<3>() = drift_weight * own.tail<3>();
  MatrixXd J = MatrixXd::Zero(count + 3, kCommon);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(3 * k);
    const auto& [t, there] = rows[k].at;
    const auto& [state, of_bias] = there;
    const Vector3d v_B = body_velocity(rows[k].at, begin_s, u, own);
    const Vector3d residual = rows[k].read - A * v_B;
    residuals.push_back(residual.norm());
    const double weight = weight_of(residual.norm(), robust_scale);
    const Matrix3d turn = A * state.C_WB.transpose();
    MatrixXd row(3, kCommon);
    row.middleCols<3>(kTurn) = -u.D * geo::skew(u.C.transpose() * v_B) / u.scale;
    row.col(kScale) = A * v_B;
    row.middleCols<3>(kLever) = -A * geo::skew(state.rate);
    row.col(kLatency) = A *
                        (body_velocity(At(strapdown, t + kTimeStep_s), begin_s, u, own) -
                         body_velocity(At(strapdown, t - kTimeStep_s), begin_s, u, own)) /
                        (2.0 * kTimeStep_s);
    const Vector3d v_W = state.C_WB * (v_B - state.rate.cross(u.lever));
    row.middleCols<3>(kRateBias) =
        -A * (state.C_WB.transpose() * (of_bias.IFC - geo::skew(v_W) * of_bias.IC) + geo::skew(u.lever)) *
        u.reading.rate;
    row.middleCols<3>(kForceBias) = turn * of_bias.IC;
    J.middleRows<3>(at) = weight * row;
    Jw.block<3, 3>(at, 0) = -weight * turn;
    Jw.block<3, 3>(at, 3) = -weight * (t - begin_s) * turn;
    Jw.block<3, 3>(at, 6) = -weight * 0.5 * (t - begin_s) * (t - begin_s) * turn;
    r.segment<3>(at) = weight * residual;
  }
  fit.add(J, Jw, r);
}

}  // namespace

DvlFigures fit_dvl(const Series& series, const std::vector<Span>& windows, const ImuReading& reading,
                   const Similarity& guess, const Vector3d& lever_B_m, double latency_s,
                   const std::optional<Vector3d>& held_D) {
  Unknowns u;
  u.C = guess.C;
  if (guess.mirrored) u.D(1, 1) = -1.0;
  u.scale = guess.scale;
  u.lever = lever_B_m;
  u.latency_s = latency_s;
  u.reading = reading;
  DvlFigures out;
  double robust_scale = 0.0;
  std::vector<MovedStrapdown> strapdowns;
  strapdowns.reserve(windows.size());
  for (const Span& window : windows)
    strapdowns.emplace_back(series.imu, reading, window.from_s - kWindowMargin_s,
                            window.to_s + kWindowMargin_s);
  for (int iteration = 0; iteration < kMostSteps; ++iteration) {
    WindowFit fit(kCommon);
    std::vector<double> residuals;
    for (std::size_t w = 0; w < windows.size(); ++w) {
      strapdowns[w].move_to(u.reading.rate_bias);
      add_window(series, windows[w], strapdowns[w], u, robust_scale, fit, residuals);
    }
    if (residuals.size() < 30) return {};
    robust_scale = std::max(1e-4, median(residuals));
    const double sigma = robust_scale / 1.54;  // median of the length of three normal numbers
    const double unit = u.scale > 0.0 ? 1.0 / u.scale : 1.0;
    for (int i = 0; i < 3; ++i) {
      fit.prior(kLever + i, u.lever[i] - lever_B_m[i], 3.0, sigma);
      fit.prior(kRateBias + i, u.reading.rate_bias[i] - reading.rate_bias[i], 0.01, sigma);
      fit.prior(kForceBias + i, u.force_bias[i], 0.2, sigma);
    }
    fit.prior(kLatency, u.latency_s - latency_s, 0.5, sigma);
    if (held_D) fit.hold(kTurn, *held_D, kHeld_rad, sigma);
    const WindowFit::Solution solution = fit.solve();
    Vector3d turn = solution.step.segment<3>(kTurn);
    if (turn.norm() > kMostTurn_rad) turn *= kMostTurn_rad / turn.norm();
    u.C = u.C * geo::to_matrix(geo::exp(turn));
    u.scale *= std::exp(std::clamp(solution.step[kScale], -0.5, 0.5));
    u.lever += solution.step.segment<3>(kLever);
    u.latency_s += std::clamp(solution.step[kLatency], -0.3, 0.3);
    u.reading.rate_bias += solution.step.segment<3>(kRateBias);
    u.force_bias += solution.step.segment<3>(kForceBias);
    const VectorXd sigmas = solution.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    out.similarity = {u.scale, u.scale * sigmas[kScale], u.C, sigmas.segment<3>(kTurn), guess.mirrored, 0.0};
    out.lever_B_m = u.lever;
    out.lever_sigma_m = sigmas.segment<3>(kLever);
    out.latency_s = u.latency_s;
    out.latency_sigma_s = sigmas[kLatency];
    out.residual_m_s = std::sqrt(solution.squares / solution.freedom) / unit;
    out.windows = solution.windows;
    out.done = solution.step.allFinite() && solution.windows >= 3;
    out.settled =
        out.done && (solution.step.segment<3>(kTurn).array().abs() < sigmas.segment<3>(kTurn).array()).all();
    if (iteration > 1 && (solution.step.array().abs() < kSettled * sigmas.array()).all()) break;
  }
  return out;
}

}  // namespace fathom::commission
