#include "estimation/navigator/model_aiding.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/aiding/model_velocity.hpp"
#include "estimation/filter/gate.hpp"
#include "estimation/hydro/shaft_speed.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

constexpr double kTurn_rad = 6.2831853071795865;

}  // namespace

ModelAiding::Drive ModelAiding::drive(const Setup& setup, const Estimate& estimate,
                                      const Measurement& measurement) {
  if (!setup.velocity_model) return Drive::nothing;
  if (const auto* fins = std::get_if<FinsSample>(&measurement.sample)) {
    if (!(std::abs(fins->rudder_rad) <= kTurn_rad) || !(std::abs(fins->stern_rad) <= kTurn_rad))
      return Drive::nothing;
    water_.set_fins(fins->rudder_rad, fins->stern_rad);
    return Drive::fins;
  }
  const auto* propulsion = std::get_if<PropulsionSample>(&measurement.sample);
  if (propulsion == nullptr) return Drive::nothing;
  if (believable_rpm(propulsion->rpm)) water_.set_rpm(propulsion->rpm);
  if (estimate.navigating && !water_.running()) {
    const NavSolution& nav = estimate.state.nav;
    water_.begin(geo::to_matrix(nav.q_NB).transpose() * (nav.v_N_m_s - estimate.current_N_m_s(setup)));
  }
  return Drive::shaft;
}

void ModelAiding::predict(const Setup& setup, const ImuStep& step, Estimate& estimate) {
  const AidingState state = estimate.aiding_state(setup);
  const double dt_s = std::max(to_seconds(step.to_ns - step.from_ns), step.gap_s);
  water_.advance(*setup.velocity_model, state.rate_nb_B_rad_s, state.C_NB.row(2).transpose(), dt_s);
  // What speaks against the model makes its slow error faster.
  const int bias = setup.index.of(Group::model_bias);
  for (int i = bias; i < bias + 2; ++i)
    estimate.filter.widen(i, (water_.model_nis() - 1.0) * setup.walk[static_cast<std::size_t>(i)] * dt_s);
}

ModelAiding::Trial ModelAiding::consider(const Setup& setup, const Estimate& estimate,
                                         const AidingState& state, const PropulsionSample& sample,
                                         bool vouched) {
  // (HYD-4)
  const VehicleModelConfig& config = setup.config.vehicle_model;
  const double surface_m = setup.config.states.surface_altitude_m;
  if (ModelVelocity::usable(state, config, water_, sample, surface_m) != Usable::yes) return {};
  const ModelVelocity model(state, config, water_);
  Observation observation;
  observe(model, setup.index, observation);
  if (observation.rows < model.dimension()) return {};
  observation.list_columns(setup.index.size());
  InnovationStatistics statistics;
  if (vouched) {
    estimate.filter.statistics(observation, 1.0, statistics);
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
  return {true, tried && !is_doubted(config),
          gate(estimate.filter, setup.model_gate, setup.model_limits, observation, statistics).pass};
}

}  // namespace fathom::estimation
