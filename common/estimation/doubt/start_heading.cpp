#include "estimation/doubt/start_heading.hpp"

#include <algorithm>
#include <cmath>

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
  considered_.fade(kept);
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
  follow<1>(step, noise, column_);
}

void StartHeading::add(const Evidence<1>& evidence, const InnovationStatistics& statistics,
                       const ErrorFilter& filter, double turn_rad_s) {
  if (!(std::abs(turn_rad_s) < kStraight_rad_s)) return;
  together_[0] += evidence.gradient[0];
  together_[1] += evidence.curvature[0];
  considered_.add(0, evidence, 0, statistics, filter);
}

double StartHeading::variance_rad2() const {
  // By how the measurements scatter about what they say together, too: they may be worse than their sigmas.
  const double scatter = std::max(1.0, scatter_.about(error_rad()) / curvature_);
  return (scatter + considered_.variance(0, 0.0) / curvature_) / curvature_;
}

void StartHeading::updated(const Observation& observation, const InnovationStatistics& statistics,
                           const ErrorFilter& filter, double turn_rad_s, ShowsStart shows) {
  if (!open_) return;
  // (GATE-9)
  const Evidence<1> evidence(column_, observation, statistics);
  if (shows == ShowsStart::yes) add(evidence, statistics, filter, turn_rad_s);
  follow(evidence, statistics, filter.estimated(), column_);
  if (std::abs(column_[8]) < kNegligible && !is_wrong()) end();
}

void StartHeading::refused(const Observation& observation, const InnovationStatistics& statistics,
                           const ErrorFilter& filter, double turn_rad_s) {
  if (!open_) return;
  // (GATE-9)
  const Evidence<1> evidence(column_, observation, statistics);
  const double gradient = evidence.gradient[0];
  const double curvature = evidence.curvature[0];
  if (!(gradient * gradient > kExplained * curvature * statistics.squared_distance)) return;
  if (!(std::abs(gradient) < kMost_rad * curvature)) return;
  add(evidence, statistics, filter, turn_rad_s);
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
  considered_ = {};
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
  if (open_) follow<1>(carry, column_);
}

bool StartHeading::is_wrong() const {
  if (!open_ || !(curvature_ * kWellKnown_rad * kWellKnown_rad > 1.0)) return false;
  if (!scatter_.are_enough(curvature_)) return false;
  const double error = error_rad();
  return std::abs(error) < kMost_rad && error * error > kCertain * kCertain * variance_rad2();
}

}  // namespace fathom::estimation
