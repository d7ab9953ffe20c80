#include "estimation/navigator/constraints.hpp"

#include "estimation/aiding/constraints.hpp"
#include "estimation/aiding/zero_velocity.hpp"

namespace fathom::estimation {
namespace {

template <class Model>
void constrain(const Setup& setup, const Model& model, Estimate& estimate) {
  Observation observation;
  observe(model, setup.index, observation);
  observation.each_alone = true;
  estimate.follow(setup);
  observation.list_columns(setup.index.size());
  InnovationStatistics statistics;
  const GateResult result =
      gate(estimate.filter, setup.constraint_gate, setup.constraint_limits, observation, statistics);
  std::array<double, kMaxStates> x{};
  if (result.pass)
    (void)estimate.update(setup, observation, statistics, VelocityOver::ground, ShowsStart::yes, x);
}

/// (AID-ZUPT-1)
bool apply_zero_velocity(const Setup& setup, Estimate& estimate) {
  estimate.follow(setup);
  const AidingState state = estimate.aiding_state(setup);
  Observation observation;
  observe(ZeroVelocity(state, setup.config.zero_velocity_sigma_m_s), setup.index, observation);
  observation.list_columns(setup.index.size());
  InnovationStatistics statistics;
  estimate.filter.statistics(observation, 1.0, statistics);
  std::array<double, kMaxStates> x{};
  // Somebody's word is not better than the instruments: nothing is believed that is far from possible.
  return !(statistics.squared_distance > 100.0) &&
         estimate.update(setup, observation, statistics, VelocityOver::ground, ShowsStart::yes, x);
}

}  // namespace

bool Constraints::apply(const Setup& setup, const ImuStep& step, Estimate& estimate) {
  bool rested = false;
  if (estimate.now_ns < rest_until_ns_ && estimate.now_ns >= next_zero_velocity_ns_) {
    next_zero_velocity_ns_ = estimate.now_ns + kNsPerSecond;
    rested = apply_zero_velocity(setup, estimate);
  }
  for_each_constraint(setup.config.constraints, [&](double rate_hz, const auto& model_of) {
    if (!step.passes_tick(from_seconds(1.0 / rate_hz))) return;
    const AidingState state = estimate.aiding_state(setup);
    constrain(setup, model_of(state), estimate);
  });
  return rested;
}

}  // namespace fathom::estimation
