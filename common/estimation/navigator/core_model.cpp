#include <algorithm>
#include <cmath>

#include "estimation/aiding/model_velocity.hpp"
#include "estimation/filter/gate.hpp"
#include "estimation/navigator/core.hpp"

namespace fathom::estimation {

using Eigen::Vector3d;

namespace {

constexpr double kTurn_rad = 6.2831853071795865;
constexpr double kMostRpm = 1e5;

}  // namespace

bool Core::drive_model(const Measurement& measurement) {
  if (!setup_->velocity_model) return false;
  if (const auto* fins = std::get_if<FinsSample>(&measurement.sample)) {
    if (!(std::abs(fins->rudder_rad) <= kTurn_rad) || !(std::abs(fins->stern_rad) <= kTurn_rad)) return false;
    water_.set_fins(fins->rudder_rad, fins->stern_rad);
    return true;
  }
  const auto* propulsion = std::get_if<PropulsionSample>(&measurement.sample);
  if (propulsion == nullptr) return false;
  if (std::abs(propulsion->rpm) < kMostRpm) water_.set_rpm(propulsion->rpm);
  if (navigating_ && !water_.running()) {
    const AidingState state = aiding_state();
    const Vector3d current(state.value(Group::current, 0), state.value(Group::current, 1), 0.0);
    water_.begin(state.C_NB.transpose() * (state_.nav.v_N_m_s - current));
  }
  return true;
}

void Core::foretell_velocity(const ImuStep& step) {
  const AidingState state = aiding_state();
  const double dt_s = std::max(to_seconds(step.to_ns - step.from_ns), step.gap_s);
  water_.advance(*setup_->velocity_model, state.rate_nb_B_rad_s, state.C_NB.row(2).transpose(), dt_s);
  // What speaks against the model makes its slow error faster.
  const int bias = setup_->index.of(Group::model_bias);
  for (int i = bias; i < bias + 2; ++i)
    filter_.widen(i, (water_.doubt() - 1.0) * setup_->walk[static_cast<std::size_t>(i)] * dt_s);
}

Core::ModelTrial Core::consider_model(const AidingState& state, const PropulsionSample& sample) {
  // (HYD-4)
  const VehicleModelConfig& config = setup_->config.vehicle_model;
  const double surface_m = setup_->config.states.surface_altitude_m;
  if (ModelVelocity::usable(state, config, water_, sample, surface_m) != Usable::yes) return {};
  const ModelVelocity model(state, config, water_);
  const bool vouched = since(dvl_used_ns_) <= setup_->config.velocity_timeout_s;
  Observation observation;
  observe(model, setup_->index, observation);
  if (observation.rows < model.dimension()) return {};
  observation.list_columns(setup_->index.size());
  InnovationStatistics statistics;
  if (vouched) {
    filter_.statistics(observation, 1.0, statistics);
    double normalised = 0.0;
    for (int i = 0; i < observation.rows; ++i) {
      const auto r = static_cast<std::size_t>(i);
      const double lasting = observation.sigma[r];
      const double variance =
          statistics.s[r * Observation::kMaxRows + r] - lasting * lasting + model.sigma(i) * model.sigma(i);
      normalised += observation.innovation[r] * observation.innovation[r] / variance / observation.rows;
    }
    water_.compare(normalised, config.memory_s);
  }
  const bool tried = vouched || water_.compared_s() >= config.trial_s;
  return {true, tried && water_.doubt() <= config.doubt_limit,
          gate(filter_, setup_->model_gate, setup_->model_limits, observation, statistics).pass};
}

}  // namespace fathom::estimation
