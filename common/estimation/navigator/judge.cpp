// One measurement's way: admit, observe, gate, reacquire, update, account.
#include <algorithm>
#include <cmath>
#include <optional>

#include "estimation/aiding/model_velocity.hpp"
#include "estimation/aiding/registry.hpp"
#include "estimation/filter/sigma_range.hpp"
#include "estimation/navigator/trial.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

constexpr double kMostRoom = 1e6;
/// An instrument that was used within this time is one that is in use.
constexpr double kHeardLately_s = 5.0;
/// For so long a time without inertial samples may be why nothing fits.
constexpr double kGapMatters_s = 120.0;

VerdictKind verdict_of(Usable usable) {
  switch (usable) {
    case Usable::yes:
      return VerdictKind::used;
    case Usable::out_of_range:
      return VerdictKind::out_of_range;
    case Usable::no_fix:
      return VerdictKind::no_fix;
    case Usable::unknown_frame:
      return VerdictKind::unknown_frame;
    case Usable::not_estimated:
    case Usable::other_model:
      break;
  }
  return VerdictKind::source_disabled;
}

}  // namespace

Judgement Navigator::judge(const Measurement& measurement, Remembered* then) {
  const auto slot = static_cast<std::size_t>(measurement.sensor);
  Trial trial{.measurement = measurement,
              .config = setup_->config.sensors[slot],
              .rules = &setup_->config.sensors[slot],
              .limits = &setup_->limits[slot],
              .instrument = instruments_.behind(*setup_, measurement),
              .then = then,
              .instant_ns = then == nullptr ? measurement.stamp_ns : then->instant_ns()};
  if (!admit(trial) || !observe(trial)) return trial.judgement;
  gate(trial);
  reacquire(trial);
  if (update(trial)) {
    account(trial);
  } else if (motion_is_lost(trial)) {
    lose_attitude();
  } else {
    doubt_start(trial);
  }
  if (trial.gated.refused != 0) usage_.note_refusal(trial.policy, estimate_.now_ns);
  note_noise(trial);
  return trial.judgement;
}

std::optional<TrustedAttitude> Navigator::attitude_to_trust(const Measurement& measurement) const {
  constexpr double kHeading_rad = 0.2;
  const bool asked = std::holds_alternative<GpsSample>(measurement.sample);
  if (!asked || !estimate_.navigating || descent_.aligning() || !(rpy_sigma_rad().z() < kHeading_rad))
    return std::nullopt;
  return TrustedAttitude{estimate_.state.nav.q_NB, estimate_.gyro_bias_rad_s(*setup_)};
}

bool Navigator::admit(Trial& trial) {
  const Measurement& measurement = trial.measurement;
  Instrument& instrument = trial.instrument;
  if (!instruments_.enabled(measurement)) return trial.end(VerdictKind::source_disabled);
  if (instrument.stamp_ns == trial.instant_ns && instrument.stamp_ns != 0)
    return trial.end(VerdictKind::duplicate);
  // What somebody told wrongly he may tell again, of the same instant.
  if (measurement.source != SourceKind::fix) instrument.stamp_ns = trial.instant_ns;
  if (trial.config.use_sample_sigma && !sound_sigmas(measurement.sample))
    return trial.end(VerdictKind::out_of_range);
  starter_.collect(*setup_, estimate_, measurement);
  const std::optional<TrustedAttitude> attitude = attitude_to_trust(measurement);
  plausibility_.measured(*setup_, measurement, attitude ? &*attitude : nullptr, estimate_.now_ns);
  trial.drive = model_.drive(*setup_, estimate_, measurement);
  if (!estimate_.navigating) return trial.end(VerdictKind::not_aligned);
  if (descent_.aligning()) {
    const std::optional<Judgement> fed = descent_.feed(*setup_, measurement, estimate_);
    if (!fed) return trial.end(VerdictKind::not_aligned);
    trial.judgement = *fed;
    if (fed->kind == VerdictKind::used) instrument.used_ns = estimate_.now_ns;
    return false;
  }
  return true;
}

bool Navigator::observe(Trial& trial) {
  estimate_.follow(*setup_);
  const EngineConfig& config = setup_->config;
  const EventSample& sample = trial.measurement.sample;
  if (trial.drive == ModelAiding::Drive::fins) {
    // They serve the model alone: what speaks against it speaks against them.
    trial.judgement.model = ModelVelocity::kName;
    return trial.end(model_.is_doubted(config.vehicle_model) ? VerdictKind::rejected : VerdictKind::used);
  }
  const AidingState state =
      estimate_.aiding_state(*setup_, trial.then == nullptr ? estimate_.state : trial.then->state());
  if (trial.drive == ModelAiding::Drive::shaft) {
    const bool vouched = estimate_.since(usage_.dvl_used_ns) <= config.velocity_timeout_s;
    trial.model = model_.consider(*setup_, estimate_, state, std::get<PropulsionSample>(sample), vouched);
    // A model that proves wrong leaves the shaft speed to the speed log, where one is configured.
    const bool wrong = trial.model.usable && !(trial.model.believed && trial.model.fits);
    trial.modelled = !(wrong && trial.config.scale_m_s_per_rpm != 0.0);
  }
  if (trial.modelled) {
    trial.rules = &setup_->model_gate;
    trial.limits = &setup_->model_limits;
  }
  const AidingInput input{.state = state,
                          .sensor = trial.config,
                          .surface_altitude_m = config.states.surface_altitude_m,
                          .vehicle_model = &config.vehicle_model,
                          .water = trial.modelled ? &model_.water_velocity() : nullptr,
                          .unused_s = estimate_.since(trial.instrument.used_ns),
                          .beacon = instruments_.beacon(trial.instrument),
                          .position_covariance_N_m2 = estimate_.filter.block3(0, 0),
                          .gps_bias_sigma_N_m = estimate_.slow_gps.sigma()};
  Usable first_refusal = Usable::yes;
  for (const AidingEntry& entry : aiding_registry()) {
    if (entry.source != trial.measurement.source) continue;
    const Usable usable = entry.observe(input, sample, trial.whole);
    if (usable == Usable::yes) {
      const AidingPolicy policy = entry.policy(trial.config, sample);
      if (trial.judgement.model.empty()) {
        trial.judgement.model = entry.name;
        trial.policy = policy;
      } else {
        trial.policy.merge(policy);
      }
    } else if (first_refusal == Usable::yes && usable != Usable::other_model) {
      first_refusal = usable;
    }
  }
  if (trial.modelled) model_.measured();
  if (trial.whole.rows == 0)
    return trial.end(first_refusal == Usable::yes ? VerdictKind::source_disabled : verdict_of(first_refusal));
  trial.with_position = trial.policy.position && measures(trial.whole, 0, 0);
  trial.fix = trial.policy.follows_motion && trial.with_position;
  trial.whole.list_columns(setup_->index.size());
  if (trial.then == nullptr) add_second_order(trial, state, input.unused_s);
  if (adapts_noise(trial)) trial.instrument.noise.widen(trial.whole);
  if (trial.then != nullptr && !trial.then->look_back(trial.whole, trial.statistics))
    return trial.end(VerdictKind::late);
  return true;
}

void Navigator::gate(Trial& trial) const {
  trial.kept.emplace(trial.whole);
  trial.gated =
      trial.then == nullptr
          ? estimation::gate(estimate_.filter, *trial.rules, *trial.limits, *trial.kept, trial.statistics)
          : estimation::gate(*trial.rules, *trial.limits, *trial.kept, trial.statistics);
}

void Navigator::reacquire(Trial& trial) {
  Judgement& judgement = trial.judgement;
  GateResult& gated = trial.gated;
  if (is_frozen(trial)) {
    judgement.kind = VerdictKind::frozen;
    trial.describe();
    return;
  }
  const bool probation = is_on_probation(trial);
  const unsigned refused = probation ? (1U << trial.whole.rows) - 1U : gated.refused;
  // Room could only be made for what the estimate is now: one that comes late has none.
  const unsigned believed =
      trial.then != nullptr
          ? 0U
          : reacquisition_.believed_rows(trial.instrument, *trial.rules, estimate_, trial.whole, refused,
                                         trial.fix, agreement_needed_s(trial));
  if (probation && believed == 0) {
    gated.pass = false;
    gated.limit = trial.config.reacquire_step_m;
    gated.test_ratio = std::hypot(trial.whole.innovation[0], trial.whole.innovation[1]) / gated.limit;
  }
  if (believed != 0 && trial.policy.heading_alone && !another_is_used(trial))
    Reacquisition::renew_compass(*setup_, estimate_, trial.whole);
  for (double room = 1.0; (believed & gated.refused) != 0 && room < kMostRoom; room *= 4.0) {
    // (GATE-3): the estimate, not the instrument, is wrong; give the estimate the room to follow.
    reacquisition_.make_room(*setup_, trial.policy, usage_.agrees_with_ground(setup_->config, estimate_),
                             trial.instrument, estimate_, trial.whole, believed, room);
    gate(trial);
  }
  if (believed != 0) trial.instrument.agrees_since_ns = 0;
  trial.stepped = gated.pass && believed != 0 && trial.with_position;
  if (gated.pass && trial.fix)
    trial.stepped =
        Reacquisition::bound_step(trial.config, estimate_, *trial.kept, trial.statistics) || trial.stepped;
  const bool disputed = trial.fix && Reacquisition::disputed(trial.instrument, trial.config, estimate_);
  judgement.kind = gated.pass ? VerdictKind::used : disputed ? VerdictKind::disputed : VerdictKind::rejected;
  if (trial.modelled && !trial.model.believed) judgement.kind = VerdictKind::rejected;
  trial.describe();
}

bool Navigator::update(Trial& trial) {
  if (trial.judgement.kind != VerdictKind::used) return false;
  if (trial.then != nullptr) {
    trial.then->acts(*trial.kept);
    // Of the present error it sees nothing: all that it says of that is in the statistics.
    trial.kept->h = {};
    trial.kept->column_count = 0;
  }
  const ShowsStart shows = trial.policy.doppler ? ShowsStart::no : ShowsStart::yes;
  if (!estimate_.update(*setup_, *trial.kept, trial.statistics, velocity_along(trial.policy), shows, trial.x))
    return trial.end(VerdictKind::rejected);
  // What it did to an error of the start, nobody has followed.
  if (trial.then != nullptr) {
    estimate_.start_heading.end();
    estimate_.motion_noise.interrupt();
  }
  bool corrected = start_was_wrong(trial);
  if (corrected) estimate_.correct_start(*setup_, velocity_along(trial.policy), trial.x);
  corrected = estimate_.correct_bias(*setup_, velocity_along(trial.policy), trial.x) || corrected;
  corrected = correct_slow_error(trial) || corrected;
  if (corrected) trial.stepped = trial.stepped || std::hypot(trial.x[0], trial.x[1]) > kNoticed_m;
  return true;
}

void Navigator::account(Trial& trial) {
  if (trial.policy.told && std::hypot(trial.x[0], trial.x[1]) > kNoticed_m) trial.stepped = true;
  if (trial.stepped)
    reacquisition_.note_step(-Vector3d(trial.x[0], trial.x[1], trial.x[2]), &trial.whole, estimate_);
  trial.instrument.stamp_ns = trial.instant_ns;
  trial.instrument.used_ns = estimate_.now_ns;
  if (trial.kept->rows > 0)
    trial.instrument.note_innovation(trial.statistics.squared_distance / trial.kept->rows);
  if (trial.instrument.agrees_since_ns == 0) trial.instrument.agrees_since_ns = estimate_.now_ns;
  const unsigned refused = trial.gated.refused;
  if ((refused & position_rows(trial.whole)) == 0) trial.instrument.candidate = {};
  usage_.note(trial.policy, trial.with_position && places(trial.whole, refused), estimate_.now_ns);
}

bool Navigator::is_frozen(Trial& trial) const {
  if (trial.rules->frozen_change <= 0.0) return false;
  Vector3d prediction = Vector3d::Zero();
  if (trial.policy.frozen_by_path) {
    // The path counts: the estimate itself may already have been pulled to the frozen fix.
    prediction = estimate_.travelled_N_m;
  } else {
    for (int i = 0; i < std::min(3, trial.whole.rows); ++i)
      prediction(i) = trial.whole.innovation[static_cast<std::size_t>(i)];
  }
  return trial.instrument.is_frozen(trial.policy.reading, prediction, trial.rules->frozen_change,
                                    estimate_.travelled_N_m, trial.policy.frozen_path_m);
}

double Navigator::agreement_needed_s(const Trial& trial) const {
  const double patience_s = trial.rules->reacquire_s;
  if (!trial.policy.heading_alone || trial.gated.refused == 0) return patience_s;
  // (GATE-7): where the position or the rates are in doubt, the gyros vouch for nothing.
  if (estimate_.since(usage_.gap_ns) <= kGapMatters_s) return patience_s;
  for (std::size_t i = 0; i < instruments_.count; ++i) {
    const Instrument& other = instruments_.sensors[i];
    const bool fresh = estimate_.since(other.candidate.last_ns) <= setup_->config.gps_timeout_s;
    if (fresh && Reacquisition::disputed(other, setup_->config.sensors[i], estimate_)) return patience_s;
  }
  const double deviations = std::abs(trial.whole.innovation[0]) / trial.gated.innovation_sigma[0];
  return Reacquisition::heading_needed_s(trial.instrument, *trial.rules, estimate_, deviations,
                                         another_is_used(trial));
}

bool Navigator::another_is_used(const Trial& trial) const {
  for (std::size_t i = 0; i < instruments_.count; ++i) {
    const Instrument& other = instruments_.sensors[i];
    if (setup_->config.sensors[i].kind == trial.config.kind && &other != &trial.instrument &&
        estimate_.since(other.used_ns) <= kHeardLately_s)
      return true;
  }
  return false;
}

bool Navigator::is_on_probation(const Trial& trial) const {
  const bool in_outage = gps_outage_s() > setup_->config.gps_timeout_s;
  return trial.fix && Reacquisition::on_probation(trial.config, trial.whole, in_outage);
}

bool Navigator::motion_is_lost(const Trial& trial) const {
  const double patience_s = trial.config.reacquire_s;
  const bool gap = estimate_.since(usage_.gap_ns) <= kGapMatters_s;
  // Comparisons with NaN are false: nothing else ever measured a velocity over ground.
  const bool alone = !(estimate_.since(usage_.bottom_used_ns) <= patience_s) &&
                     !setup_->config.constraints.non_holonomic.enabled;
  const bool starts_again =
      setup_->config.alignment.mode != StartMode::at_rest && !waits_for_state() && starter_.goes_fast();
  return gap && alone && starts_again && patience_s > 0.0 && trial.judgement.kind == VerdictKind::disputed &&
         trial.policy.fix == Fix::satellite &&
         estimate_.since(trial.instrument.candidate.since_ns) < 0.5 * patience_s;
}

VelocityOver Navigator::velocity_along(const AidingPolicy& policy) const {
  const bool ground = policy.doppler ? policy.velocity == VelocityOver::ground
                                     : usage_.knows_ground(setup_->config, estimate_);
  return ground ? VelocityOver::ground : VelocityOver::medium;
}

}  // namespace fathom::estimation
