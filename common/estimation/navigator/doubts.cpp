// What a measurement says against what was assumed: of the start, of an instrument's noise and slow error.
#include <cmath>

#include "estimation/navigator/trial.hpp"

namespace fathom::estimation {

using Eigen::Vector3d;

bool Navigator::start_was_wrong(const Trial& trial) const {
  // Without positions nothing but the Earth's rate shows a heading, and that faintly.
  const NavMode mode = usage_.mode(setup_->config, estimate_);
  const bool placed =
      trial.policy.fix != Fix::none || mode == NavMode::gps_aided || mode == NavMode::acoustic_aided;
  return placed && estimate_.start_heading.is_wrong();
}

void Navigator::doubt_start(Trial& trial) {
  const VerdictKind kind = trial.judgement.kind;
  const bool refused = kind == VerdictKind::rejected || kind == VerdictKind::disputed;
  // Through the water or the air a change of the current would be taken for the heading.
  const bool over_ground = trial.policy.velocity == VelocityOver::ground || trial.policy.fix != Fix::none;
  if (!refused || !over_ground || trial.then != nullptr || !estimate_.start_heading.is_open()) return;
  estimate_.filter.statistics(trial.whole, 1.0, trial.statistics);
  estimate_.start_heading.refused(trial.whole, trial.statistics, estimate_.filter, estimate_.turn_rad_s());
  if (!start_was_wrong(trial)) return;
  estimate_.correct_start(*setup_, velocity_along(trial.policy), trial.x);
  const Vector3d step_N_m(trial.x[0], trial.x[1], trial.x[2]);
  if (step_N_m.head<2>().norm() > kNoticed_m) reacquisition_.note_step(-step_N_m, nullptr, estimate_);
}

bool Navigator::adapts_noise(const Trial& trial) const {
  return trial.config.max_noise_factor > 1.0 && !trial.modelled && !trial.policy.told;
}

void Navigator::note_noise(Trial& trial) const {
  // (GATE-10): what comes late or repeats itself has no neighbour to be compared with.
  if (!adapts_noise(trial) || trial.then != nullptr || trial.instrument.repeats) return;
  trial.instrument.noise.note({.now_ns = estimate_.now_ns,
                               .used = trial.judgement.kind == VerdictKind::used,
                               .rows = trial.whole,
                               .innovation_sigma = trial.gated.innovation_sigma,
                               .moved = trial.x,
                               .most = trial.config.max_noise_factor});
}

bool Navigator::correct_slow_error(Trial& trial) {
  // (GATE-13)
  if (trial.then != nullptr || !adapts_noise(trial)) return false;
  const Observation& rows = trial.whole;
  bool corrected = false;
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows.rows); ++row) {
    if (!(rows.stated[row] > 0.0)) continue;
    const std::size_t component = rows.component[row];
    const int error = rows.slow_state[row];
    const double scatters = trial.instrument.noise.white_share(component) * rows.sigma[row] * rows.sigma[row];
    const double shown = rows.h[row][static_cast<std::size_t>(error)];
    const double variance = (rows.stated[row] - scatters) / (shown * shown);
    if (!estimate_.correct_slow_error(*setup_, error, variance, velocity_along(trial.policy), trial.x))
      continue;
    trial.instrument.noise.expect_noise(component);
    corrected = true;
  }
  return corrected;
}

}  // namespace fathom::estimation
