#include "estimation/engine/history.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace fathom::estimation {
namespace {

/// Room for young snapshots.
constexpr std::size_t kYoung = 48;
/// So many events are looked at one by one before the rest is halved.
constexpr std::size_t kNewest = 6;
/// A second navigator that is set back again and again finishes at once after so many samples.
constexpr int kMostCatching = 32;

std::size_t step_capacity(const EngineConfig& config) {
  const double span = config.horizon_s + 2.0 * config.snapshot_interval_s;
  return static_cast<std::size_t>(std::ceil(1.5 * span * config.imu.nominal_rate_hz)) + 64;
}

std::size_t snapshot_capacity(const EngineConfig& config) {
  // Beside the regular ones those that stand closer: eight for each factor of e in age. Late measurements may
  // leave two in each interval.
  const auto regular = static_cast<std::size_t>(std::ceil(config.horizon_s / config.snapshot_interval_s));
  return std::max(regular + kYoung, 2 * regular) + 4;
}

}  // namespace

History::History(const Setup& setup)
    : setup_(&setup),
      horizon_ns_(from_seconds(setup.config.horizon_s)),
      snapshot_interval_ns_(from_seconds(setup.config.snapshot_interval_s)),
      past_(setup),
      leg_without_past_(setup.index.size()),
      steps_(step_capacity(setup.config)),
      navigators_(snapshot_capacity(setup.config) + 1, Navigator(setup)),
      legs_(past_.on() ? navigators_.size() : 0, Leg(setup.index.size())),
      present_(static_cast<std::uint16_t>(navigators_.size() - 1)),
      marks_(navigators_.size() - 1),
      pool_(setup.config.measurement_capacity),
      order_(setup.config.measurement_capacity),
      judgements_(setup.config.measurement_capacity),
      catching_(setup),
      catching_leg_(setup.index.size()) {
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint16_t>(i);
  for (std::size_t i = 0; i < marks_.size(); ++i) marks_[i].place = static_cast<std::uint16_t>(i);
}

std::size_t History::first_after(TimeNs stamp_ns) const {
  // Most ask for the newest.
  std::size_t rank = event_count_;
  for (std::size_t i = 0; i < kNewest; ++i, --rank)
    if (rank == 0 || pool_[order_[rank - 1]].stamp_ns <= stamp_ns) return rank;
  const auto begin = order_.begin();
  const auto found =
      std::upper_bound(begin, begin + static_cast<std::ptrdiff_t>(rank), stamp_ns,
                       [this](TimeNs stamp, std::uint16_t place) { return stamp < pool_[place].stamp_ns; });
  return static_cast<std::size_t>(found - begin);
}

History::Placing History::insert(const Measurement& measurement, VerdictSink& sink) {
  if (!started_) return Placing::not_started;
  const TimeNs newest = present().now_ns();
  const TimeNs stamp = measurement.stamp_ns;
  if (stamp > newest + future_tolerance_ns(measurement)) return Placing::from_the_future;
  const TimeNs horizon = newest - horizon_ns_;
  if (stamp < horizon || stamp <= marks_[0].now_ns) return Placing::late;
  if (event_count_ == order_.size()) {
    // Full: the oldest goes, and with it the snapshots before it, which could no longer be repeated truly.
    std::size_t kept = 0;
    while (kept < snapshot_count_ && marks_[kept].now_ns < event(0).stamp_ns) ++kept;
    if (kept == snapshot_count_) return Placing::late;
    const TimeNs floor = marks_[kept].now_ns;
    const bool needed =
        (dirty_ns_ != 0 && dirty_ns_ <= floor) || (catching_up_ && catching_.now_ns() < floor);
    if (stamp <= floor || needed) return Placing::late;
    for (std::size_t i = 0; i < kept; ++i) drop_snapshot(0);
    drop_before(floor, sink);
  }
  const auto begin = order_.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(event_count_);
  const auto key = measurement.key();
  const auto place = std::lower_bound(
      begin, end, key, [this](std::uint16_t one, const auto& wanted) { return pool_[one].key() < wanted; });
  if (place != end && pool_[*place].key() == key) return Placing::duplicate;
  const std::uint16_t slot = order_[event_count_];
  pool_[slot] = measurement;
  std::move_backward(place, end, end + 1);
  *place = slot;
  ++event_count_;
  anticipation_.heard(measurement, newest);
  if (stamp <= newest && (dirty_ns_ == 0 || stamp < dirty_ns_)) dirty_ns_ = stamp;
  return Placing::taken;
}

void History::advance(const ImuStep& step, VerdictSink& sink) {
  steps_[steps_done_ % steps_.size()] = step;
  const std::uint64_t target = steps_done_ + 1;
  go_back();
  repeat_until(target, sink);
  if (catching_up_) {
    ++catching_for_;
    const bool forget = target - caught_up_step_ + 1 >= steps_.size();
    const std::uint64_t most = setup_->config.replay_steps_per_sample;
    catch_up(forget || catching_for_ >= kMostCatching ? target : most, sink);
  }
  settle_past(sink);
}

std::uint64_t History::steps_since(TimeNs stamp_ns, std::uint64_t first) const {
  while (first < steps_done_ && steps_[first % steps_.size()].to_ns < stamp_ns) ++first;
  return steps_done_ - first;
}

TimeNs History::oldest_ns() const {
  const TimeNs oldest = marks_[0].now_ns;
  return catching_up_ ? std::min(oldest, catching_.now_ns()) : oldest;
}

void History::catch_up(std::uint64_t steps, VerdictSink& sink) {
  for (std::uint64_t i = 0; i < steps && caught_up_step_ < steps_done_; ++i) {
    run(catching_, catching_leg_, steps_[caught_up_step_ % steps_.size()], sink);
    ++caught_up_step_;
    ++repeated_steps_;
    const auto begin = marks_.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(snapshot_count_);
    const auto passed =
        std::lower_bound(begin, end, caught_up_step_,
                         [](const Mark& one, std::uint64_t step) { return one.after_step < step; });
    if (passed != end && passed->after_step == caught_up_step_) {
      navigators_[passed->place] = catching_;
      if (past_.on()) legs_[passed->place] = catching_leg_;
    }
  }
  if (caught_up_step_ < steps_done_) return;
  present() = catching_;
  if (past_.on()) present_leg() = catching_leg_;
  catching_up_ = false;
}

void History::settle(VerdictSink& sink) {
  if (!started_) return;
  const std::uint64_t target = steps_done_;
  go_back();
  repeat_until(target, sink);
  if (catching_up_) catch_up(target, sink);
  Judgement unplaced;
  unplaced.kind = VerdictKind::from_the_future;
  std::size_t kept = first_after(present().now_ns());
  for (std::size_t rank = kept; rank < event_count_; ++rank) {
    // An order stays for the step that may yet come.
    if (event(rank).command) {
      std::swap(order_[kept++], order_[rank]);
    } else {
      say(event(rank), unplaced, true, sink);
    }
  }
  event_count_ = kept;
  snapshot_count_ = 0;
  save(sink);
}

void History::repeat_until(std::uint64_t target, VerdictSink& sink) {
  const TimeNs newest_ns =
      target == steps_done_ ? present().now_ns() : steps_[(target - 1) % steps_.size()].to_ns;
  bool saved = false;
  while (steps_done_ < target) {
    const ImuStep& step = steps_[steps_done_ % steps_.size()];
    run(present(), present_leg(), step, sink);
    ++steps_done_;
    const TimeNs expected_until_ns = anticipation_.expected_until_ns(step.to_ns, step.to_ns - step.from_ns);
    if (save_due(newest_ns, expected_until_ns)) {
      save(sink, expected_until_ns);
      saved = true;
    } else {
      TimeNs& kept_until_ns = marks_[snapshot_count_ - 1].kept_until_ns;
      kept_until_ns = std::max(kept_until_ns, expected_until_ns);
    }
    // A snapshot from which some step since is no longer held is of no use.
    while (snapshot_count_ > 1 && steps_done_ - marks_[0].after_step >= steps_.size()) {
      drop_snapshot(0);
      drop_before(oldest_ns(), sink);
    }
  }
  if (saved) thin_snapshots(newest_ns);
}

DurationNs History::future_tolerance_ns(const Measurement& measurement) const {
  // An order waits for its instant.
  return measurement.command ? horizon_ns_ : from_seconds(setup_->config.future_tolerance_s);
}

Judgement History::act(Navigator& navigator, Leg& leg, const Measurement& event) {
  const bool late =
      past_.on() && !event.command && event.stamp_ns != instant_of(*setup_, event.header(), event.sensor);
  return late ? past_.judge(navigator, leg, event) : navigator.apply(event);
}

void History::run(Navigator& navigator, Leg& leg, const ImuStep& step, VerdictSink& sink) {
  if (past_.on()) navigator.record_to(&leg.passage);
  for (std::size_t rank = first_after(step.from_ns); rank < event_count_; ++rank) {
    Measurement& one = event(rank);
    if (one.stamp_ns > step.to_ns) break;
    navigator.advance(step, one.stamp_ns);
    const Judgement judgement = act(navigator, leg, one);
    if (one.settled) continue;
    judgements_[order_[rank]] = judgement;
    if (!one.judged || judgement.kind != one.said) say(one, judgement, false, sink);
  }
  navigator.advance(step, step.to_ns);
  navigator.finish(step);
  if (!past_.on()) return;
  past_.follow(navigator, leg);
  navigator.record_to(nullptr);  // whoever copies it tells nothing
}

void History::drop_before(TimeNs stamp_ns, VerdictSink& sink) {
  const std::size_t count = first_after(stamp_ns);
  if (count == 0) return;
  settle_first(count, VerdictKind::late, sink);
  settled_count_ -= count;
  const auto begin = order_.begin();
  std::rotate(begin, begin + static_cast<std::ptrdiff_t>(count),
              begin + static_cast<std::ptrdiff_t>(event_count_));
  event_count_ -= count;
}

void History::say(Measurement& event, const Judgement& judgement, bool is_final, VerdictSink& sink) {
  const VerdictKind previous = event.judged ? event.said : judgement.kind;
  if (event.judged) ++event.revision;
  event.judged = true;
  event.settled = is_final;
  event.said = judgement.kind;
  sink.judged(event, judgement, previous);
}

void History::settle_first(std::size_t count, VerdictKind unjudged, VerdictSink& sink) {
  Judgement none;
  none.kind = unjudged;
  for (; settled_count_ < count; ++settled_count_) {
    Measurement& one = event(settled_count_);
    // What became of an order is said when it acts; it has no final verdict.
    if (one.settled || (one.command && one.judged)) continue;
    say(one, one.judged ? judgement(settled_count_) : none, true, sink);
  }
}

void History::settle_past(VerdictSink& sink) {
  // What insert() takes in is younger than this,
  TimeNs until_ns = std::max(marks_[0].now_ns, present().now_ns() - horizon_ns_ - 1);
  // and the second navigator judges what is younger than itself again.
  if (catching_up_) until_ns = std::min(until_ns, catching_.now_ns());
  while (settled_count_ < event_count_ && event(settled_count_).stamp_ns <= until_ns)
    settle_first(settled_count_ + 1, VerdictKind::late, sink);
}

void History::forget_past(VerdictSink& sink, VerdictKind verdict) {
  settle_first(event_count_, verdict, sink);
  forget();
}

void History::forget() {
  event_count_ = 0;
  settled_count_ = 0;
  snapshot_count_ = 0;
  steps_done_ = 0;
  fine_until_step_ = 0;
  anticipation_.forget();
  dirty_ns_ = 0;
  catching_up_ = false;
}

void History::begin(TimeNs now_ns, VerdictSink& sink) {
  present().rebase(now_ns, 0.0);
  started_ = true;
  save(sink);
}

void History::begin_given(const InitialState& initial, TimeNs now_ns, VerdictSink& sink) {
  forget_past(sink, VerdictKind::not_aligned);
  Past::forget(present_leg());
  present().start(initial, now_ns);
  started_ = true;
  save(sink);
}

void History::rebase(TimeNs now_ns, double unobserved_s, VerdictSink& sink) {
  if (catching_up_) catch_up(steps_done_, sink);
  forget_past(sink, VerdictKind::late);
  Past::forget(present_leg());  // which had other stamps
  present().rebase(now_ns, unobserved_s);
  save(sink);
}

void History::clear(VerdictSink& sink) {
  forget_past(sink, VerdictKind::not_aligned);
  Past::forget(present_leg());
  present() = Navigator(*setup_);
  started_ = false;
}

}  // namespace fathom::estimation
