#include "estimation/alignment/acceleration_start.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace fathom::estimation {
namespace {

using Eigen::Dynamic;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMostMarks = static_cast<int>(VelocityTrack::kMarks);
constexpr int kLeast = 6;
constexpr int kBeginnings = 8;
constexpr int kIterations = 12;
constexpr double kLongestStep_rad = 0.5;
constexpr double kConverged_rad = 1e-4;
/// Attitudes that differ by this are two.
constexpr double kApart_rad = 0.3;
/// Twice the logarithm by which the likelihood of another attitude has to be less.
constexpr double kClear = 20.0;
/// Mean square of what is left over, in units of its variance: what is worse comes from something else.
constexpr double kWorst = 16.0;
/// No receiver is better; keeps the covariance positive.
constexpr double kLeastSigma_m_s = 1e-3;
/// What is said to have no bias may have that.
constexpr double kLeastGyroBias_rad_s = 1e-9;
constexpr double kLeastForceError_m_s2 = 1e-6;
constexpr double kLeastMeanForce_m_s2 = 1.0;

/// Unknowns: rotation of the attitude now about N, velocity at the first mark, bias of gyros and
/// accelerometers.
constexpr int kUnknowns = 12;
using Rows = Eigen::Matrix<double, Dynamic, kUnknowns + 1, 0, 3 * kMostMarks, kUnknowns + 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Factor = Eigen::Matrix<double, Dynamic, Dynamic, 0, kMostMarks, kMostMarks>;

/// Increments from the first mark to each, in the axes that B had at the first, less the biases.
struct Composed {
  std::array<Matrix3d, kMostMarks> C_first;  ///< B at the mark relative to B at the first
  std::array<Vector3d, kMostMarks> dv_m_s;
  std::array<Matrix3d, kMostMarks> by_accel_bias;
  std::array<Matrix3d, kMostMarks> by_gyro_bias;
  Matrix3d turn_by_bias = Matrix3d::Zero();
};

class AccelerationFit {
 public:
  AccelerationFit(const VelocityTrack& track, const AccelerationStartInputs& in)
      : track_(track),
        in_(in),
        n_(static_cast<int>(track.size())),
        gyro_sigma_rad_s_(std::max(kLeastGyroBias_rad_s, in.gyro_bias_sigma_rad_s)),
        force_sigma_m_s2_(
            std::hypot(kLeastForceError_m_s2, in.accel_bias_sigma_m_s2, in.accel_shape_sigma_m_s2)) {
    measure();
  }

  struct Solution {
    Matrix3d C_N_first = Matrix3d::Identity();
    Matrix3d C_N_now = Matrix3d::Identity();
    Vector3d v_first_N_m_s = Vector3d::Zero();
    Vector3d gyro_bias_B_rad_s = Vector3d::Zero();
    Vector3d force_error_B_m_s2 = Vector3d::Zero();
    double cost = 0.0;  ///< sum of squares in units of their variances
    bool converged = false;
  };
  /// From this attitude of B at the first mark.
  [[nodiscard]] Solution solve(const Matrix3d& C_N_first) const;
  /// Of all directions; none where it is not clearly the best, or not good.
  [[nodiscard]] std::optional<Solution> best() const;
  [[nodiscard]] std::optional<AccelerationStart> start(const Solution& found) const;

 private:
  void measure();
  [[nodiscard]] Vector3d antenna(const VelocityMark& mark) const {
    return geo::cross(mark.rate_B_rad_s, in_.lever_B_m);
  }
  [[nodiscard]] const VelocityMark& mark(int k) const { return track_.mark(static_cast<std::size_t>(k)); }
  [[nodiscard]] Composed compose(const Solution& at) const;
  /// Whitened rows of the linearised measurements at a solution; what is left over stands in the last column.
  [[nodiscard]] Rows rows(const Solution& at, const Composed& composed) const;
  [[nodiscard]] Normal normal(const Rows& rows) const;
  [[nodiscard]] double freedom() const { return 3.0 * n_ - 6.0; }

  const VelocityTrack& track_;
  const AccelerationStartInputs& in_;
  int n_;
  double gyro_sigma_rad_s_;
  double force_sigma_m_s2_;
  std::array<double, kMostMarks> t_s_{};  ///< since the first mark
  Factor horizontal_;                     ///< lower factors of the covariance of the velocities
  Factor vertical_;
};

void AccelerationFit::measure() {
  // (ALN-24)
  Eigen::Vector2d changed = Eigen::Vector2d::Zero();
  for (int k = 1; k < n_; ++k) {
    const double dt_s = mark(k).span.duration_s;
    t_s_[static_cast<std::size_t>(k)] = t_s_[static_cast<std::size_t>(k - 1)] + dt_s;
    changed += ((mark(k).v_N_m_s - mark(k - 1).v_N_m_s).head<2>() / dt_s).cwiseAbs2();
  }
  const double late2 = in_.latency_sigma_s * in_.latency_sigma_s * 0.5 * changed.sum() / (n_ - 1);
  const double white2 = in_.velocity_random_walk_m_s_sqrt_s * in_.velocity_random_walk_m_s_sqrt_s;
  const double tilting = in_.gravity_N_m_s2.norm() * in_.angle_random_walk_rad_sqrt_s;
  Factor horizontal(n_, n_);
  Factor vertical(n_, n_);
  for (int j = 0; j < n_; ++j) {
    const double a = t_s_[static_cast<std::size_t>(j)];
    for (int k = j; k < n_; ++k) {
      const double b = t_s_[static_cast<std::size_t>(k)];
      vertical(k, j) = white2 * a;
      horizontal(k, j) = white2 * a + tilting * tilting * a * a * (3.0 * b - a) / 6.0;
    }
    const Vector3d sigma = mark(j).sigma_m_s.cwiseMax(kLeastSigma_m_s);
    horizontal(j, j) += sigma.head<2>().cwiseAbs2().maxCoeff() + late2;
    vertical(j, j) += sigma.z() * sigma.z();
  }
  horizontal_ = horizontal.llt().matrixL();
  vertical_ = vertical.llt().matrixL();
}

Composed AccelerationFit::compose(const Solution& at) const {
  Composed out;
  out.C_first[0] = Matrix3d::Identity();
  out.dv_m_s[0] = Vector3d::Zero();
  out.by_accel_bias[0] = out.by_gyro_bias[0] = Matrix3d::Zero();
  for (int k = 1; k < n_; ++k) {
    const auto now = static_cast<std::size_t>(k);
    const InertialSpan& span = mark(k).span;
    const Matrix3d& c = out.C_first[now - 1];
    const Vector3d dv = c * (span.dv_m_s - span.dv_by_gyro_bias * at.gyro_bias_B_rad_s -
                             span.by_accel_bias * at.force_error_B_m_s2);
    out.by_gyro_bias[now] =
        out.by_gyro_bias[now - 1] + c * span.dv_by_gyro_bias - geo::skew(dv) * out.turn_by_bias;
    out.by_accel_bias[now] = out.by_accel_bias[now - 1] + c * span.by_accel_bias;
    out.dv_m_s[now] = out.dv_m_s[now - 1] + dv;
    out.turn_by_bias += c * span.turn_by_bias;
    out.C_first[now] = c * geo::to_matrix(geo::exp(-span.turn_by_bias * at.gyro_bias_B_rad_s)) *
                       geo::to_matrix(span.q_start_now);
  }
  return out;
}

Rows AccelerationFit::rows(const Solution& at, const Composed& composed) const {
  Rows out(3 * n_, kUnknowns + 1);
  for (int k = 0; k < n_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vector3d moved_N = at.C_N_first * (composed.dv_m_s[i] + composed.C_first[i] * antenna(mark(k)));
    const Matrix3d by_turn = -geo::skew(moved_N);
    Eigen::Matrix<double, 3, kUnknowns + 1> block;
    block << by_turn, Matrix3d::Identity(),
        by_turn * at.C_N_first * composed.turn_by_bias - at.C_N_first * composed.by_gyro_bias[i],
        -at.C_N_first * composed.by_accel_bias[i],
        mark(k).v_N_m_s - at.v_first_N_m_s - moved_N - t_s_[i] * in_.gravity_N_m_s2;
    for (int axis = 0; axis < 3; ++axis) out.row(axis * n_ + k) = block.row(axis);
  }
  for (int axis = 0; axis < 3; ++axis) {
    auto part = out.middleRows(axis * n_, n_);
    (axis < 2 ? horizontal_ : vertical_).triangularView<Eigen::Lower>().solveInPlace(part);
  }
  return out;
}

Normal AccelerationFit::normal(const Rows& rows) const {
  Normal out = rows.leftCols<kUnknowns>().transpose() * rows.leftCols<kUnknowns>();
  for (int i = 0; i < 3; ++i) {
    out(6 + i, 6 + i) += 1.0 / (gyro_sigma_rad_s_ * gyro_sigma_rad_s_);
    out(9 + i, 9 + i) += 1.0 / (force_sigma_m_s2_ * force_sigma_m_s2_);
  }
  return out;
}

AccelerationFit::Solution AccelerationFit::solve(const Matrix3d& C_N_first) const {
  Solution at;
  at.C_N_first = C_N_first;
  at.v_first_N_m_s = mark(0).v_N_m_s;
  for (int round = 0; round < kIterations; ++round) {
    const Composed composed = compose(at);
    const Rows measured = rows(at, composed);
    const Vector3d gyro = at.gyro_bias_B_rad_s / gyro_sigma_rad_s_;
    const Vector3d accel = at.force_error_B_m_s2 / force_sigma_m_s2_;
    at.cost = measured.col(kUnknowns).squaredNorm() + gyro.squaredNorm() + accel.squaredNorm();
    at.C_N_now = at.C_N_first * composed.C_first[static_cast<std::size_t>(n_ - 1)];
    if (at.converged) break;
    Unknowns right = measured.leftCols<kUnknowns>().transpose() * measured.col(kUnknowns);
    right.segment<3>(6) -= gyro / gyro_sigma_rad_s_;
    right.segment<3>(9) -= accel / force_sigma_m_s2_;
    Unknowns step = normal(measured).ldlt().solve(right);
    const double turn_rad = step.head<3>().norm();
    if (!(turn_rad < 1e6)) break;
    if (turn_rad > kLongestStep_rad) step *= kLongestStep_rad / turn_rad;
    at.converged = turn_rad < kConverged_rad;
    const Vector3d first_rad = step.head<3>() + at.C_N_first * (composed.turn_by_bias * step.segment<3>(6));
    at.C_N_first = geo::to_matrix(geo::exp(first_rad)) * at.C_N_first;
    at.v_first_N_m_s += step.segment<3>(3);
    at.gyro_bias_B_rad_s += step.segment<3>(6);
    at.force_error_B_m_s2 += step.segment<3>(9);
  }
  return at;
}

std::optional<AccelerationFit::Solution> AccelerationFit::best() const {
  // The mean of what was felt fixes two angles (ALN-6); the third is tried all round.
  const double t_s = t_s_[static_cast<std::size_t>(n_ - 1)];
  const Vector3d felt = compose({}).dv_m_s[static_cast<std::size_t>(n_ - 1)] / t_s;
  const Vector3d up = (mark(n_ - 1).v_N_m_s - mark(0).v_N_m_s) / t_s - in_.gravity_N_m_s2;
  if (!felt.allFinite() || !up.allFinite()) return std::nullopt;
  if (std::min(felt.norm(), up.norm()) < kLeastMeanForce_m_s2) return std::nullopt;
  const Matrix3d level = geo::to_matrix(geo::turn_between(felt.normalized(), up.normalized()));
  std::array<Solution, kBeginnings> all;
  std::size_t best = 0;
  for (std::size_t i = 0; i < kBeginnings; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / kBeginnings;
    all[i] = solve(Eigen::AngleAxisd(angle, up.normalized()).toRotationMatrix() * level);
    if (all[i].cost < all[best].cost) best = i;
  }
  const Solution& found = all[best];
  const double ratio = found.cost / freedom();
  if (!found.converged || !(ratio < kWorst)) return std::nullopt;
  for (const Solution& one : all) {
    const Eigen::AngleAxisd apart(one.C_N_now * found.C_N_now.transpose());
    if (std::abs(apart.angle()) > kApart_rad && !(one.cost - found.cost > kClear * std::max(1.0, ratio)))
      return std::nullopt;
  }
  return found;
}

std::optional<AccelerationStart> AccelerationFit::start(const Solution& found) const {
  const Composed composed = compose(found);
  const Rows measured = rows(found, composed);
  const Normal covariance = normal(measured).inverse();
  const double ratio = std::max(1.0, found.cost / freedom());
  // Rotation by what was measured, as the filter begins: with biases of zero.
  const Eigen::Matrix<double, 3, Dynamic, 0, 3, 3 * kMostMarks> gain =
      covariance.topRows<3>() * measured.leftCols<kUnknowns>().transpose();
  const Matrix3d by_accel_bias = -gain * measured.middleCols<3>(9);
  Matrix3d by_newest;  // found by an error of the newest velocity
  for (int axis = 0; axis < 3; ++axis)
    by_newest.col(axis) = gain.col(axis * n_ + n_ - 1) / (axis < 2 ? horizontal_ : vertical_)(n_ - 1, n_ - 1);

  const VelocityMark& newest = track_.newest();
  const InertialSpan& after = track_.since_newest();
  const Matrix3d by_gyro_bias = -gain * measured.middleCols<3>(6) - found.C_N_now * after.turn_by_bias;
  const double t_s = t_s_[static_cast<std::size_t>(n_ - 1)];
  AccelerationStart out;
  MovingStart& start = out.start;
  const Matrix3d C_N_now = found.C_N_now * geo::to_matrix(after.q_start_now);
  start.q_NB = geo::normalized(geo::from_matrix(C_N_now));
  start.v_N_m_s = newest.v_N_m_s - found.C_N_now * antenna(newest) + found.C_N_now * after.dv_m_s +
                  after.duration_s * in_.gravity_N_m_s2;
  const Vector3d variance = ratio * newest.sigma_m_s.cwiseAbs2();
  start.P_vv = variance.asDiagonal();
  start.P_vp = variance.asDiagonal() * by_newest.transpose();
  start.P_pp = ratio * gain * gain.transpose();
  start.P_pp.diagonal().array() += in_.angle_random_walk_rad_sqrt_s * in_.angle_random_walk_rad_sqrt_s * t_s;
  start.by_accel_bias = by_accel_bias;
  start.by_gyro_bias = by_gyro_bias;

  double turned2 = 0.0;
  Vector3d turn_B = Vector3d::Zero();
  const Matrix3d& C_first_newest = composed.C_first[static_cast<std::size_t>(n_ - 1)];
  for (int k = 0; k < n_; ++k) {
    const Matrix3d since = composed.C_first[static_cast<std::size_t>(k)].transpose() * C_first_newest;
    turned2 += std::pow(Eigen::AngleAxisd(since).angle(), 2) / n_;
    if (k > 0) turn_B += geo::log(mark(k).span.q_start_now);
  }
  start.P_pp(2, 2) += in_.turn_error_sigma * in_.turn_error_sigma * turned2;
  start.mean_force_B_m_s2 =
      C_first_newest.transpose() * composed.dv_m_s[static_cast<std::size_t>(n_ - 1)] / t_s;
  start.mean_rate_B_rad_s = turn_B / t_s;

  const Matrix3d whole = start.P_pp +
                         gyro_sigma_rad_s_ * gyro_sigma_rad_s_ * by_gyro_bias * by_gyro_bias.transpose() +
                         force_sigma_m_s2_ * force_sigma_m_s2_ * by_accel_bias * by_accel_bias.transpose();
  if (!whole.allFinite()) return std::nullopt;
  start.P_pp += in_.unexplained_force_sigma_m_s2 * in_.unexplained_force_sigma_m_s2 * by_accel_bias *
                by_accel_bias.transpose();
  out.sigma_N_rad = whole.diagonal().cwiseSqrt();
  return out;
}

}  // namespace

std::optional<AccelerationStart> start_by_accelerations(const VelocityTrack& track,
                                                        const AccelerationStartInputs& in) {
  if (track.size() < static_cast<std::size_t>(kLeast)) return std::nullopt;
  const AccelerationFit fit(track, in);
  const auto found = fit.best();
  return found ? fit.start(*found) : std::nullopt;
}

}  // namespace fathom::estimation
