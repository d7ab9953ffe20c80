#pragma once

#include <optional>

#include "estimation/navigator/constraints.hpp"
#include "estimation/navigator/estimate.hpp"
#include "estimation/navigator/instruments.hpp"
#include "estimation/navigator/model_aiding.hpp"
#include "estimation/navigator/plausibility/plausibility.hpp"
#include "estimation/navigator/reacquisition.hpp"
#include "estimation/navigator/remembered.hpp"
#include "estimation/navigator/start/alignment_watch.hpp"
#include "estimation/navigator/start/descent.hpp"
#include "estimation/navigator/start/ordered_position.hpp"
#include "estimation/navigator/start/starter.hpp"
#include "estimation/navigator/usage.hpp"

namespace fathom::estimation {

/// The navigator as a value: a deterministic function of the inertial steps and events applied to it so far.
/// Copying it is taking a snapshot; that is what makes late measurements possible (history.hpp). Nothing here
/// knows about arrival order, verdict queues or wall clocks.
///
/// It owns parts, each with the state and the code of one question; what they share is the Estimate.
class Navigator {
 public:
  explicit Navigator(const Setup& setup);

  /// Integrates within the interval, from now_ns() until an instant in it.
  void advance(const ImuStep& step, TimeNs until_ns) { estimate_.advance(*setup_, step, until_ns); }
  /// Lets the covariance follow to now: before it is copied for work of its own.
  void follow() { estimate_.follow(*setup_); }
  /// Called once at the end of each interval: alignment, phases, zero velocity.
  void finish(const ImuStep& step);
  /// Applies one event at the present instant.
  Judgement apply(const Measurement& measurement);
  /// One that speaks of an instant long before the present one, at which it acts.
  Judgement apply_late(const Measurement& measurement, Remembered& then) { return judge(measurement, &then); }
  /// Starts at `now_ns` from a given state.
  void start(const InitialState& initial, TimeNs now_ns);
  /// Another estimate for the present instant, as the smoother has it.
  void replace(const FilterState& state, const ErrorFilter& filter) {
    estimate_.replace(*setup_, state, filter);
  }
  void record_to(FilterTape* tape) { estimate_.filter.record_to(tape); }
  /// Puts the present instant elsewhere on the time axis, after a step of the stamps.
  void rebase(TimeNs now_ns, double unobserved_s);

  [[nodiscard]] const Estimate& estimate() const { return estimate_; }
  [[nodiscard]] bool navigating() const { return estimate_.navigating; }
  [[nodiscard]] TimeNs now_ns() const { return estimate_.now_ns; }
  [[nodiscard]] const FilterState& state() const { return estimate_.state; }
  /// Up to a stride behind now(): no sigma in it grows noticeably meanwhile.
  [[nodiscard]] const ErrorFilter& filter() const { return estimate_.filter; }
  [[nodiscard]] const Eigen::Vector3d& rate_B_rad_s() const { return estimate_.rate_B_rad_s; }
  [[nodiscard]] const Eigen::Vector3d& force_B_m_s2() const { return estimate_.force_B_m_s2; }
  [[nodiscard]] OutputAttitude output_attitude() const {
    return estimation::output_attitude(*setup_, estimate_);
  }
  /// Sigmas of roll, pitch and yaw of the axes that are published; unknown without navigation.
  [[nodiscard]] Eigen::Vector3d rpy_sigma_rad() const;
  /// Adds to `filter` what moves biases in `dt_s` from `ahead_s` after now on, beside the drift of the setup.
  void drive_biases(ErrorFilter& filter, double ahead_s, double dt_s) const {
    estimate_.drive_biases(*setup_, filter, ahead_s, dt_s);
  }

  [[nodiscard]] const AlignmentWatch& alignment() const { return alignment_; }
  [[nodiscard]] const Starter& starter() const { return starter_; }
  /// What cannot be right; nothing aligns while there is anything.
  [[nodiscard]] const PlausibilityFinding& implausible() const { return plausibility_.finding(); }
  [[nodiscard]] Plausible plausible() const {
    if (plausibility_.finding()) return Plausible::no;
    return plausibility_.has_heard() && !is_doubted() ? Plausible::yes : Plausible::not_heard_enough;
  }
  /// The instruments contradict each other. That keeps from aligning; what is aligned stays so until it is
  /// claimed which one is wrong.
  [[nodiscard]] bool is_doubted() const {
    return alignment_.phase != AlignmentPhase::aligned && plausibility_.is_doubted();
  }
  /// For how long the inertial unit has to be heard still; 0: it was.
  [[nodiscard]] double unheard_s() const { return plausibility_.unheard_s(); }
  [[nodiscard]] double course_sigma_rad() const { return starter_.course_sigma_rad(start_inputs()); }
  [[nodiscard]] double acceleration_heading_sigma_rad() const {
    return starter_.acceleration_heading_sigma_rad();
  }
  [[nodiscard]] StartConditions conditions() const { return starter_.conditions(start_inputs()); }
  [[nodiscard]] const Descent& descent() const { return descent_; }
  /// Only a state from outside can start it: what the configuration says, and no release has happened yet.
  [[nodiscard]] bool waits_for_state() const;

  [[nodiscard]] NavMode mode() const;
  /// Since the last use, NaN before the first.
  [[nodiscard]] double gps_outage_s() const { return estimate_.since(usage_.gps_used_ns); }
  [[nodiscard]] double dvl_outage_s() const { return estimate_.since(usage_.dvl_used_ns); }
  [[nodiscard]] const Reacquisition& reacquisition() const { return reacquisition_; }
  [[nodiscard]] const Instrument& sensor(int number) const {
    return instruments_.sensors[static_cast<std::size_t>(number)];
  }
  /// Of a DVL, what is measured against the water; null for others.
  [[nodiscard]] const Instrument* water_layer(int number) const {
    const int layer = setup_->water_layer[static_cast<std::size_t>(number)];
    return layer < 0 ? nullptr : &instruments_.water_layers[static_cast<std::size_t>(layer)];
  }
  /// How many times as much a sensor scatters as is said of it, of its worst component (GATE-10).
  [[nodiscard]] double noise_factor(int number) const { return instruments_.noise_factor(*setup_, number); }
  /// Of the slow error of GPS; 0 where there is no state of it.
  [[nodiscard]] std::array<double, 3> gps_bias_sigma_N_m() const { return estimate_.slow_gps.sigma(); }
  [[nodiscard]] const hydro::WaterVelocity& water_velocity() const { return model_.water_velocity(); }

  /// For archives: see fields/navigator.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  // judge.cpp
  /// One measurement on its way through the judge.
  struct Trial;
  Judgement judge(const Measurement& measurement, Remembered* then = nullptr);
  /// Whether it may be looked at at all. Parts that have a use for it beside the filter have it then.
  bool admit(Trial& trial);
  /// Of the estimate, for those who see GPS's velocity in the body; none while heading is not known to that.
  [[nodiscard]] std::optional<TrustedAttitude> attitude_to_trust(const Measurement& measurement) const;
  /// What the aiding models make of it; false when there is nothing for the filter in it.
  bool observe(Trial& trial);
  /// What the rows see beyond the first order, where attitude and velocity are known badly.
  void add_second_order(Trial& trial, const AidingState& state, double unused_s) const;
  void gate(Trial& trial) const;
  /// A refusal may not be the last word: the estimate, not the instrument, may be wrong.
  void reacquire(Trial& trial);
  bool update(Trial& trial);
  /// Notes what a used measurement means for mode, outages and steps.
  void account(Trial& trial);
  [[nodiscard]] bool is_frozen(Trial& trial) const;
  /// For so long refusals have to agree with each other until they are believed.
  [[nodiscard]] double agreement_needed_s(const Trial& trial) const;
  /// Beside the one of the trial, an instrument of its kind.
  [[nodiscard]] bool another_is_used(const Trial& trial) const;
  [[nodiscard]] bool is_on_probation(const Trial& trial) const;
  /// (GATE-6)
  [[nodiscard]] bool motion_is_lost(const Trial& trial) const;
  /// What is measured along the vehicle's own axes: over ground while a DVL does, else through the water.
  [[nodiscard]] VelocityOver velocity_along(const AidingPolicy& policy) const;

  // doubts.cpp
  /// (GATE-9): by what is known with this measurement.
  [[nodiscard]] bool start_was_wrong(const Trial& trial) const;
  /// A refused measurement may speak of the start.
  void doubt_start(Trial& trial);
  /// (GATE-10)
  [[nodiscard]] bool adapts_noise(const Trial& trial) const;
  void note_noise(Trial& trial) const;
  /// (GATE-13) False, with nothing changed, if it is not larger than is known.
  bool correct_slow_error(Trial& trial);

  // navigator.cpp
  /// `used` when it is done. `rejected` when it is a position that is held until it is confirmed; innovation
  /// is the way to it (m, north and east), `limit` how long that may be, test_ratio its length over that.
  Judgement execute(const Command& command);
  Judgement place(const Command& command);
  void realign();
  void finish_gap(double gap_s);
  void align(const ImuStep& step);
  void lose_attitude();
  /// Nothing of the estimate is worth anything: it is no number, or beyond a pole.
  void lose_all();
  [[nodiscard]] StartInputs start_inputs() const { return {*setup_, estimate_, ordered_}; }
  /// No instant that is remembered lies after now.
  [[nodiscard]] bool remembers_the_past_only() const;

  const Setup* setup_;
  Estimate estimate_;
  Instruments instruments_;
  Usage usage_;
  Reacquisition reacquisition_;
  Constraints constraints_;
  ModelAiding model_;
  AlignmentWatch alignment_;
  Starter starter_;
  Descent descent_;
  OrderedPosition ordered_;
  Plausibility plausibility_;
};

}  // namespace fathom::estimation
