#include "estimation/doubt/start_heading.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "estimation/filter/adjoint.hpp"

namespace fathom::estimation {
namespace {

/// And what they say of the start has to be known as well as this.
constexpr double kWellKnown_rad = 0.06;
/// Measurements of so long a time count as one: what is wrong with an instrument lasts for longer than from
/// one measurement to the next.
constexpr double kTogether_s = 2.0;
/// In a turn levers and delays that are wrong look like a heading that is.
constexpr double kStraight_rad_s = 0.05;
/// What is linear about it ends here.
constexpr double kMost_rad = 1.5;
/// What is said slowly is not believed: so do errors that no model has, as they last for minutes.
constexpr double kMemory_s = 60.0;
/// A refused measurement speaks of the start where a wrong heading explains this share of its squared
/// innovation.
constexpr double kExplained = 0.5;
/// Less than this share of an error of the start is left: it does not matter any more.
constexpr double kNegligible = 0.3;

}  // namespace

void StartHeading::propagated(const NavTransition& step, const ProcessNoise& noise) {
  if (!open_) return;
  const double kept = std::exp(-step.dt_s() / kMemory_s);
  gradient_ *= kept;
  curvature_ *= kept;
  for (double& one : scatter_.sums) one *= kept * kept;
  together_s_ += step.dt_s();
  if (together_s_ >= kTogether_s) {
    const auto [gradient, curvature] = together_;
    gradient_ += gradient;
    curvature_ += curvature;
    scatter_.add(gradient, curvature);
    together_ = {};
    together_s_ = 0.0;
  }
  // Of rows that are kRowStride apart, as the step wants them, the first two columns; the second is zero.
  alignas(64) std::array<double, static_cast<std::size_t>(kMaxStates) * kRowStride> rows;
  for (std::size_t i = 0; i < kMaxStates; ++i) {
    rows[i * kRowStride] = column_[i];
    rows[i * kRowStride + 1] = 0.0;
  }
  step.apply(rows.data(), 2);
  for (std::size_t i = 0; i < kNavStates; ++i) column_[i] = rows[i * kRowStride];
  if (noise.drift == nullptr) return;
  for (const std::uint8_t state : noise.drift->decaying())
    column_[state] *= noise.drift->kept(state, step.dt_s());
}

/// What an error at the start does to a measurement's components, and what they say of it.
struct StartHeading::Evidence {
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Observation::kMaxRows, 1>;

  Evidence(const Column& column, const Observation& observation, const InnovationStatistics& statistics) {
    const Eigen::Index m = statistics.rows;
    Vector innovation(m);
    Vector seen = Vector::Zero(m);  // H u
    UpdateRecord::Square s(m, m);
    for (Eigen::Index i = 0; i < m; ++i) {
      const auto row = static_cast<std::size_t>(i);
      innovation(i) = observation.innovation[row];
      for (int c = 0; c < observation.column_count; ++c) {
        const auto state = observation.columns[static_cast<std::size_t>(c)];
        seen(i) += observation.h[row][state] * column[state];
      }
      for (Eigen::Index j = 0; j < m; ++j)
        s(i, j) = statistics.s[row * kStatisticsStride + static_cast<std::size_t>(j)];
    }
    weighed = s.llt().solve(seen);
    gradient = weighed.dot(innovation);
    curvature = weighed.dot(seen);
  }

  Vector weighed;  ///< S^-1 H u
  double gradient = 0.0;
  double curvature = 0.0;
};

void StartHeading::add(const Evidence& evidence, double turn_rad_s) {
  if (!(std::abs(turn_rad_s) < kStraight_rad_s)) return;
  together_[0] += evidence.gradient;
  together_[1] += evidence.curvature;
}

double StartHeading::variance_rad2() const {
  // By how the measurements scatter about what they say together, too: they may be worse than their sigmas.
  return std::max(1.0, scatter_.about(error_rad()) / curvature_) / curvature_;
}

void StartHeading::updated(const Observation& observation, const InnovationStatistics& statistics,
                           int estimated, double turn_rad_s) {
  if (!open_) return;
  // (GATE-9)
  const Evidence evidence(column_, observation, statistics);
  add(evidence, turn_rad_s);
  for (int i = 0; i < statistics.rows; ++i) {
    const double* ph = statistics.ph.data() + static_cast<std::size_t>(i) * kMaxStates;
    for (int j = 0; j < estimated; ++j) column_[static_cast<std::size_t>(j)] -= ph[j] * evidence.weighed(i);
  }
  if (std::abs(column_[8]) < kNegligible && !is_wrong()) end();
}

void StartHeading::refused(const Observation& observation, const InnovationStatistics& statistics,
                           double turn_rad_s) {
  if (!open_) return;
  // (GATE-9)
  const Evidence evidence(column_, observation, statistics);
  const double explained = evidence.gradient * evidence.gradient;
  if (!(explained > kExplained * evidence.curvature * statistics.squared_distance)) return;
  if (!(std::abs(evidence.gradient) < kMost_rad * evidence.curvature)) return;
  add(evidence, turn_rad_s);
}

void StartHeading::corrected() {
  // (KF-4): an error about down is that of the heading turned round.
  found_rad_ -= error_rad();
  forget_evidence();
  if (++corrections_ == kMostCorrections) end();
}

void StartHeading::forget_evidence() {
  gradient_ = curvature_ = 0.0;
  scatter_ = {};
  together_ = {};
  together_s_ = 0.0;
}

void StartHeading::shifted(const Column& column, double share, std::size_t state) {
  if (!open_) return;
  const double by = share * column_[state];
  for (std::size_t i = 0; i < column_.size(); ++i) column_[i] += by * column[i];
  forget_evidence();
}

void StartHeading::carried(const Carry& carry) {
  if (!open_) return;
  Eigen::Map<Eigen::Matrix<double, Carry::kStates, 1>> part(column_.data() + Carry::kFirst);
  part = (carry.matrix() * part).eval();
}

bool StartHeading::is_wrong() const {
  if (!open_ || !(curvature_ * kWellKnown_rad * kWellKnown_rad > 1.0)) return false;
  if (!scatter_.are_enough(curvature_)) return false;
  const double error = error_rad();
  return std::abs(error) < kMost_rad && error * error > kCertain * kCertain * variance_rad2();
}

}  // namespace fathom::estimation
