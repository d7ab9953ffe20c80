#include "estimation/navigator/navigator.hpp"

#include <algorithm>

namespace fathom::estimation {

using Eigen::Vector3d;

namespace {

/// How often the sigmas are held against what counts as aligned.
constexpr DurationNs kJudged_ns = 50'000'000;

/// (ALN-19) What swung when a gap began may have swung on for a while, and a turn may have ended at any time.
void widen_by_motion(const ImuStep& step, Estimate& estimate) {
  constexpr double kSwing_s = 1.0;  // a quarter of a wave
  constexpr int kAttitude = 6;
  const Vector3d rate_B_rad_s = step.increments.dtheta_rad / step.increments.dt_s;  // as at both ends
  const double turn_rad = 0.5 * step.gap_s * geo::to_matrix(estimate.state.nav.q_NB).row(2).dot(rate_B_rad_s);
  const double swing_rad = std::min(step.gap_s, kSwing_s) * rate_B_rad_s.norm();
  for (int i = 0; i < 3; ++i) estimate.filter.widen(kAttitude + i, swing_rad * swing_rad);
  estimate.filter.widen(kAttitude + 2, turn_rad * turn_rad);
}

}  // namespace

Navigator::Navigator(const Setup& setup) : setup_(&setup), estimate_(setup), instruments_(setup) {}

void Navigator::finish(const ImuStep& step) {
  if (estimate_.navigating && !estimate_.is_sound()) lose_all();
  if (step.gap_s > 0.0) {
    finish_gap(step.gap_s);
    if (estimate_.navigating && step.increments.dt_s > 0.0) widen_by_motion(step, estimate_);
  }
  plausibility_.add(*setup_, step, estimate_.now_ns);
  if (!estimate_.navigating) {
    align(step);
    return;
  }
  if (descent_.aligning()) {
    descent_.advance(*setup_, step, estimate_, alignment_);
    return;
  }
  if (step.passes_tick(kJudged_ns)) starter_.see(*setup_, estimate_);
  if (setup_->velocity_model) model_.predict(*setup_, step, estimate_);
  if (constraints_.apply(*setup_, step, estimate_)) usage_.velocity_used_ns = estimate_.now_ns;
  // On a grid of its own: whatever comes late puts strides elsewhere, and the phase must not hang on that.
  if (step.passes_tick(kJudged_ns) || plausibility_.finding())
    alignment_.judge(setup_->config, rpy_sigma_rad(), plausible(), estimate_.now_ns);
}

void Navigator::finish_gap(double gap_s) {
  estimate_.follow(*setup_);
  usage_.gap_ns = estimate_.now_ns;
  if (gap_s > setup_->config.imu.lost_gap_s) {
    if (!descent_.resume(*setup_, gap_s, estimate_, alignment_)) {
      lose_attitude();
      starter_.lose_sight();
    }
  } else if (estimate_.navigating) {
    const GapSigma sigma(setup_->config.imu, gap_s);
    estimate_.widen(sigma);
    if (descent_.aligning()) descent_.widen(*setup_, sigma);
  }
  starter_.interrupt();
}

void Navigator::align(const ImuStep& step) {
  if (alignment_.phase == AlignmentPhase::none) {
    alignment_.enter(AlignmentPhase::waiting, estimate_.now_ns);
    alignment_.waiting_since_ns = estimate_.now_ns;
  }
  if (waits_for_state() || step.increments.dt_s <= 0.0) return;
  if (plausibility_.finding()) {
    starter_.interrupt();
    alignment_.enter(alignment_.is_late(setup_->config, estimate_.now_ns) ? AlignmentPhase::timed_out
                                                                          : AlignmentPhase::waiting,
                     estimate_.now_ns);
    return;
  }
  if (!starter_.align(start_inputs(), descent_.released(), step, estimate_, alignment_)) return;
  model_.stop();
  ordered_.is_set = false;
  alignment_.hold_since_ns = 0;
  alignment_.enter(AlignmentPhase::fine, estimate_.now_ns);
}

Judgement Navigator::apply(const Measurement& measurement) {
  return measurement.command ? execute(std::get<Command>(measurement.sample)) : judge(measurement);
}

Judgement Navigator::execute(const Command& command) {
  estimate_.follow(*setup_);
  const auto& sensors = setup_->config.sensors;
  Judgement done;
  done.kind = VerdictKind::used;
  switch (command.kind) {
    case CommandKind::enable_source:
    case CommandKind::disable_source:
      for (std::size_t i = 0; i < sensors.size(); ++i)
        if (command.target == Name(sensors[i].sensor))
          instruments_.sensors[i].enabled = command.kind == CommandKind::enable_source;
      break;
    case CommandKind::mark_at_rest:
      constraints_.mark_at_rest(estimate_.now_ns, command.value_s);
      break;
    case CommandKind::realign:
      realign();
      break;
    case CommandKind::set_position:
      return place(command);
    case CommandKind::acknowledge_alarm:
      break;
  }
  return done;
}

void Navigator::realign() {
  if (descent_.released() && estimate_.navigating) {
    // Under way there is nothing to stand still for: tilt is found again, the rest carried on.
    descent_.restart(*setup_, setup_->config.air_drop.tilt_sigma_rad, 0.0, estimate_, alignment_);
    return;
  }
  lose_attitude();
  plausibility_.forget();
  alignment_.enter(AlignmentPhase::waiting, estimate_.now_ns);
}

Judgement Navigator::place(const Command& command) {
  if (!estimate_.navigating) {
    ordered_.keep(estimate_, command);
    Judgement done;
    done.kind = VerdictKind::used;
    return done;
  }
  const OrderedPosition::Step step = ordered_.propose(*setup_, estimate_, command);
  if (step.judgement.kind != VerdictKind::used) return step.judgement;
  reacquisition_.note_step(step.step_N_m, nullptr, estimate_);
  estimate_.state.nav.position = step.wanted;
  for (int i = 0; i < step.axes; ++i) estimate_.forget(i, command.sigma_m);
  if (descent_.aligning()) descent_.place(*setup_, step.axes, command.sigma_m);
  return step.judgement;
}

void Navigator::start(const InitialState& initial, TimeNs now_ns) {
  begin_given(*setup_, initial, now_ns, estimate_);
  alignment_.hold_since_ns = 0;
  if (setup_->config.alignment.mode == StartMode::air_drop) {
    descent_.start(*setup_, initial, estimate_, alignment_);
  } else {
    plausibility_.vouch();
    alignment_.enter(AlignmentPhase::fine, estimate_.now_ns);
  }
}

void Navigator::rebase(TimeNs now_ns, double unobserved_s) {
  const DurationNs shift = now_ns - estimate_.now_ns - from_seconds(unobserved_s);
  const auto move = [shift](TimeNs& stamp) {
    if (stamp != 0) stamp += shift;
  };
  move(estimate_.began_ns);
  Usage::for_each_instant(usage_, move);
  Reacquisition::for_each_instant(reacquisition_, move);
  Constraints::for_each_instant(constraints_, move);
  AlignmentWatch::for_each_instant(alignment_, move);
  Starter::for_each_instant(starter_, move);
  OrderedPosition::for_each_instant(ordered_, move);
  Plausibility::for_each_instant(plausibility_, move);
  Instruments::for_each(instruments_, [&](Instrument& one) {
    Instrument::for_each_instant(one, move);
    one.stamp_ns = 0;
  });
  estimate_.now_ns = now_ns;
  ImuStep silence;
  silence.gap_s = unobserved_s;
  if (!(unobserved_s > 0.0) || !estimate_.navigating) return;
  NavSolution& nav = estimate_.state.nav;
  nav.position = geo::moved_by(nav.position, unobserved_s * nav.v_N_m_s);
  finish(silence);
}

bool Navigator::remembers_the_past_only() const {
  bool past = true;
  const auto hold = [&](TimeNs stamp_ns) { past = past && (stamp_ns == 0 || stamp_ns <= estimate_.now_ns); };
  hold(estimate_.began_ns);
  Usage::for_each_instant(usage_, hold);
  Reacquisition::for_each_instant(reacquisition_, hold);
  AlignmentWatch::for_each_instant(alignment_, hold);
  Starter::for_each_instant(starter_, hold);
  OrderedPosition::for_each_instant(ordered_, hold);
  Plausibility::for_each_instant(plausibility_, hold);
  Instruments::for_each(instruments_,
                        [&](const Instrument& one) { Instrument::for_each_instant(one, hold); });
  return past;
}

void Navigator::lose_attitude() {
  estimate_.navigating = false;
  estimate_.stride = {};
  estimate_.levelled = false;
  descent_.give_up();
  starter_.forget();
  alignment_.enter(AlignmentPhase::lost, estimate_.now_ns);
  alignment_.waiting_since_ns = estimate_.now_ns;
}

void Navigator::lose_all() {
  lose_attitude();
  starter_.lose_sight();
  const TimeNs now_ns = estimate_.now_ns;
  FilterTape* const tape = estimate_.filter.tape();
  estimate_ = Estimate(*setup_);
  estimate_.filter.record_to(tape);
  estimate_.now_ns = now_ns;
}

bool Navigator::waits_for_state() const {
  const StartMode mode = setup_->config.alignment.mode;
  return (mode == StartMode::given && !starter_.has_lost_sight()) ||
         (mode == StartMode::air_drop && !descent_.released());
}

Vector3d Navigator::rpy_sigma_rad() const {
  if (!estimate_.navigating) return Vector3d::Constant(kUnknown);
  return descent_.rpy_sigma_rad(*setup_, estimate_);
}

NavMode Navigator::mode() const {
  if (!estimate_.navigating) return estimate_.levelled ? NavMode::aligning : NavMode::none;
  return usage_.mode(setup_->config, estimate_);
}

}  // namespace fathom::estimation
