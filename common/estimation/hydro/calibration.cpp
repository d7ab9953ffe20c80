#include "estimation/hydro/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <Eigen/Cholesky>

#include "estimation/hydro/water_velocity.hpp"

namespace fathom::estimation::hydro {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kLeastTime_s = 60.0;
constexpr double kSmallestStep = 1e-4;  // of the sum of squares, relative: the fit stands

bool of_force_rows(const CoefficientEntry& one) {
  const std::string_view name = one.name;
  return one.kind != CoefficientKind::body && (name[0] == 'X' || name[0] == 'Y' || name[0] == 'Z');
}

/// The unknowns in one vector: shares by which the coefficients differ from the start, current north and
/// east, velocity through the water at the beginning.
class Problem {
 public:
  Problem(const HydroCoefficients& start, const std::vector<CalibrationPoint>& log,
          const CalibrationConfig& config)
      : start_(start), log_(log), config_(config) {
    for (const CoefficientEntry& one : coefficient_table())
      if (of_force_rows(one) && start.*one.member != 0.0) entries_.push_back(&one);
    for (const CalibrationPoint& point : log) rows_ += point.vouched ? 3 : 0;
  }

  [[nodiscard]] const std::vector<const CoefficientEntry*>& entries() const { return entries_; }
  [[nodiscard]] Eigen::Index shares() const { return static_cast<Eigen::Index>(entries_.size()); }
  [[nodiscard]] Eigen::Index unknowns() const { return shares() + 5; }
  [[nodiscard]] Eigen::Index rows() const { return rows_; }

  [[nodiscard]] HydroCoefficients coefficients(const VectorXd& x) const {
    HydroCoefficients out = start_;
    for (std::size_t i = 0; i < entries_.size(); ++i)
      out.*entries_[i]->member *= 1.0 + x(static_cast<Eigen::Index>(i));
    return out;
  }
  /// Where the log begins to know.
  [[nodiscard]] VectorXd beginning() const {
    VectorXd x = VectorXd::Zero(unknowns());
    x.tail<3>() = log_.front().V_ground_B_m_s;
    return x;
  }
  [[nodiscard]] VectorXd prior_sigma() const {
    VectorXd sigma = VectorXd::Constant(unknowns(), config_.share_sigma);
    sigma.segment<2>(shares()).setConstant(config_.current_sigma_m_s);
    sigma.tail<3>().setConstant(config_.velocity_sigma_m_s);
    return sigma;
  }
  /// Velocity over ground that the model predicts less the one of the log, at the vouched points; nothing
  /// where these coefficients are no vehicle.
  [[nodiscard]] std::optional<VectorXd> residuals(const VectorXd& x) const {
    const HydroCoefficients c = coefficients(x);
    if (!c.validate().empty()) return std::nullopt;
    const VelocityModel model(c);
    const Vector3d current_N(x(shares()), x(shares() + 1), 0.0);
    Vector3d V = x.tail<3>();
    Vector3d omega_before = log_.front().omega_B_rad_s;
    VectorXd out(rows_);
    Eigen::Index row = 0;
    for (const CalibrationPoint& point : log_) {
      if (point.dt_s > 0.0) {
        V = model.step(V, omega_before, point.omega_B_rad_s, point.C_NB.row(2).transpose(), point.controls,
                       point.dt_s);
      }
      omega_before = point.omega_B_rad_s;
      if (!point.vouched) continue;
      out.segment<3>(row) = V + point.C_NB.transpose() * current_N - point.V_ground_B_m_s;
      row += 3;
    }
    if (!out.allFinite()) return std::nullopt;
    return out;
  }
  [[nodiscard]] MatrixXd jacobian(const VectorXd& x) const {
    MatrixXd out(rows_, unknowns());
    for (Eigen::Index i = 0; i < unknowns(); ++i) {
      constexpr double kStep = 1e-4;
      VectorXd more = x;
      VectorXd less = x;
      more(i) += kStep;
      less(i) -= kStep;
      const auto above = residuals(more);
      const auto below = residuals(less);
      if (above && below) {
        out.col(i) = (*above - *below) / (2.0 * kStep);
      } else {
        out.col(i).setZero();  // at the edge of what is a vehicle: left where it is
      }
    }
    return out;
  }

 private:
  const HydroCoefficients& start_;
  const std::vector<CalibrationPoint>& log_;
  const CalibrationConfig& config_;
  std::vector<const CoefficientEntry*> entries_;
  Eigen::Index rows_ = 0;
};

/// Of each component, with as many independent values as the correlation from one to the next leaves.
struct Noise {
  Vector3d rms = Vector3d::Zero();
  Vector3d weight = Vector3d::Zero();  ///< of one squared residual
};

Noise noise_of(const VectorXd& residuals, double least_m_s) {
  const Eigen::Index n = residuals.size() / 3;
  Noise out;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double squares = 0.0;
    double neighbours = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      squares += residuals(3 * i + axis) * residuals(3 * i + axis);
      if (i > 0) neighbours += residuals(3 * i + axis) * residuals(3 * (i - 1) + axis);
    }
    const double correlation = squares > 0.0 ? std::clamp(neighbours / squares, 0.0, 0.999) : 0.0;
    const double variance = std::max(squares / static_cast<double>(n), least_m_s * least_m_s);
    out.rms(axis) = std::sqrt(squares / static_cast<double>(n));
    out.weight(axis) = (1.0 - correlation) / (1.0 + correlation) / variance;
  }
  return out;
}

struct Fit {
  VectorXd x;
  MatrixXd covariance;
  Noise noise;
};

/// Damped Gauss-Newton with the prior, the residuals' own noise taken anew in each step (HYD-5). `free` tells
/// which unknowns may move.
std::optional<Fit> fit(const Problem& problem, VectorXd x, const std::vector<bool>& free,
                       const CalibrationConfig& config) {
  const VectorXd origin = problem.beginning();
  const VectorXd prior = problem.prior_sigma().array().square().inverse();
  auto residuals = problem.residuals(x);
  if (!residuals) return std::nullopt;
  Fit out;
  for (int round = 0; round < config.iterations; ++round) {
    out.noise = noise_of(*residuals, config.least_sigma_m_s);
    const auto cost = [&](const VectorXd& at, const VectorXd& r) {
      double sum = ((at - origin).array().square() * prior.array()).sum();
      for (Eigen::Index i = 0; i < r.size(); ++i) sum += r(i) * r(i) * out.noise.weight(i % 3);
      return sum;
    };
    MatrixXd j = problem.jacobian(x);
    for (Eigen::Index i = 0; i < j.cols(); ++i)
      if (!free[static_cast<std::size_t>(i)]) j.col(i).setZero();
    MatrixXd weighted = j;
    for (Eigen::Index i = 0; i < j.rows(); ++i) weighted.row(i) *= out.noise.weight(i % 3);
    MatrixXd information = j.transpose() * weighted;
    information.diagonal() += prior;
    const Eigen::LLT<MatrixXd> factor(information);
    if (factor.info() != Eigen::Success) return std::nullopt;
    out.covariance = factor.solve(MatrixXd::Identity(j.cols(), j.cols()));
    VectorXd step = -factor.solve(weighted.transpose() * *residuals + prior.cwiseProduct(x - origin));
    for (Eigen::Index i = 0; i < step.size(); ++i)
      if (!free[static_cast<std::size_t>(i)]) step(i) = 0.0;
    const double before = cost(x, *residuals);
    bool better = false;
    double gained = 0.0;
    for (double share = 1.0; share > 1e-3 && !better; share *= 0.5) {
      const VectorXd tried = x + share * step;
      const auto there = problem.residuals(tried);
      if (!there) continue;
      const double after = cost(tried, *there);
      if (!(after < before)) continue;
      better = true;
      gained = before - after;
      x = tried;
      residuals = there;
    }
    if (!better || gained < kSmallestStep * before) break;
  }
  out.noise = noise_of(*residuals, config.least_sigma_m_s);
  out.x = x;
  return out;
}

}  // namespace

Calibration calibrate(const HydroCoefficients& start, const std::vector<CalibrationPoint>& log,
                      const CalibrationConfig& config) {
  Calibration out;
  out.coefficients = start;
  for (const CalibrationPoint& point : log) out.compared_s += point.vouched ? point.dt_s : 0.0;
  if (out.compared_s < kLeastTime_s) {
    out.failure = "the DVL stands behind " + std::to_string(static_cast<int>(out.compared_s)) +
                  " s under water, expected at least 60 s";
    return out;
  }
  const Problem problem(start, log, config);
  // First current and start alone: what the coefficients do as they are.
  std::vector<bool> free(static_cast<std::size_t>(problem.unknowns()), false);
  std::fill(free.end() - 5, free.end(), true);
  const auto before = fit(problem, problem.beginning(), free, config);
  std::fill(free.begin(), free.end(), true);
  const auto after = before ? fit(problem, before->x, free, config) : std::nullopt;
  if (!after) {
    out.failure = "the model runs away on this log, expected coefficients of the vehicle that made it";
    return out;
  }
  out.residual_before_m_s = before->noise.rms;
  out.residual_after_m_s = after->noise.rms;
  out.coefficients = problem.coefficients(after->x);
  const VectorXd sigma = after->covariance.diagonal().cwiseSqrt();
  for (std::size_t i = 0; i < problem.entries().size(); ++i) {
    const CoefficientEntry* entry = problem.entries()[i];
    const auto k = static_cast<Eigen::Index>(i);
    out.found.push_back({entry, start.*entry->member, out.coefficients.*entry->member,
                         sigma(k) * std::abs(start.*entry->member),
                         sigma(k) <= config.observable_share * config.share_sigma});
  }
  out.current_N_m_s = after->x.segment<2>(problem.shares());
  out.current_sigma_m_s = sigma.segment<2>(problem.shares());
  return out;
}

}  // namespace fathom::estimation::hydro
