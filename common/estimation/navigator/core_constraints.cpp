// What is known about the motion without an instrument. These rows come with the inertial steps, at instants
// that depend on nothing but the stamps, so a roll-back repeats them to the bit.
#include "estimation/aiding/constant_depth.hpp"
#include "estimation/aiding/non_holonomic.hpp"
#include "estimation/aiding/zero_velocity.hpp"
#include "estimation/navigator/core.hpp"

namespace fathom::estimation {
namespace {

/// A tick of the grid of this rate lies within the step.
bool due(const ImuStep& step, double rate_hz) {
  const DurationNs period = from_seconds(1.0 / rate_hz);
  return step.to_ns / period != step.from_ns / period;
}

}  // namespace

void Core::apply_constraints(const ImuStep& step) {
  const ConstraintsConfig& constraints = setup_->config.constraints;
  if (now_ns_ < rest_until_ns_ && now_ns_ >= next_zero_velocity_ns_) {
    next_zero_velocity_ns_ = now_ns_ + kNsPerSecond;
    apply_zero_velocity();
  }
  if (constraints.non_holonomic.enabled && due(step, constraints.non_holonomic.rate_hz)) {
    Observation observation;
    observe(NonHolonomic(aiding_state(), constraints.non_holonomic), setup_->index, observation);
    constrain(observation);
  }
  if (constraints.constant_depth.enabled && due(step, constraints.constant_depth.rate_hz)) {
    Observation observation;
    observe(ConstantDepth(aiding_state(), constraints.constant_depth.sigma_m_s), setup_->index, observation);
    constrain(observation);
  }
}

void Core::constrain(Observation& observation) {
  observation.each_alone = true;
  observation.list_columns(setup_->index.size());
  InnovationStatistics statistics;
  const GateResult result =
      gate(filter_, setup_->constraint_gate, setup_->constraint_limits, observation, statistics);
  std::array<double, kMaxStates> x{};
  if (result.pass && filter_.update(observation, statistics, x))
    remove_error(x, setup_->index.size(), state_);
}

void Core::apply_zero_velocity() {
  // (AID-ZUPT-1)
  const AidingState state = aiding_state();
  Observation observation;
  observe(ZeroVelocity(state, setup_->config.zero_velocity_sigma_m_s), setup_->index, observation);
  observation.list_columns(setup_->index.size());
  InnovationStatistics statistics;
  filter_.statistics(observation, 1.0, statistics);
  std::array<double, kMaxStates> x{};
  // Somebody's word is not better than the instruments: nothing is believed that is far from possible.
  if (statistics.squared_distance > 100.0 || !filter_.update(observation, statistics, x)) return;
  remove_error(x, setup_->index.size(), state_);
  velocity_used_ns_ = now_ns_;
}

}  // namespace fathom::estimation
