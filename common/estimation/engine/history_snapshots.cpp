// Where a history keeps snapshots, and what becomes of them.
#include <algorithm>

#include "estimation/engine/history.hpp"

namespace fathom::estimation {
namespace {

/// Steps between the youngest.
constexpr std::uint64_t kFineSteps = 3;
/// A snapshot that stands no further before what is expected serves it as well.
constexpr std::uint64_t kNearSteps = 2;
/// So much room is left to snapshots that nothing is expected behind.
constexpr std::size_t kUnexpected = 16;
/// An eighth of the age between snapshots, a quarter where one between two is given up.
constexpr DurationNs kSaveShare = 8;
constexpr DurationNs kThinShare = 4;
/// Of the interval between snapshots: one that stands no further from the one before it may be used up.
constexpr DurationNs kConsumedShare = 3;

}  // namespace

std::size_t History::snapshot_before(TimeNs stamp_ns) const {
  std::size_t at = snapshot_count_ - 1;
  while (at > 0 && marks_[at].now_ns >= stamp_ns) --at;
  return at;
}

void History::go_back() {
  if (dirty_ns_ == 0) return;
  // insert() has seen to it that there is a snapshot before it.
  const TimeNs late_ns = dirty_ns_;
  dirty_ns_ = 0;
  const std::size_t at = snapshot_before(late_ns);
  // Of the steps behind it, not of those behind the snapshot: equal events, equal states.
  const std::uint64_t needed = steps_since(late_ns, marks_[at].after_step);
  const std::uint64_t wasted = steps_done_ - marks_[at].after_step - needed;
  const bool dear = needed > setup_->config.replay_steps_per_sample;
  // Snapshots that stand close cost something with each step: they pay where the waste is the greater part.
  if (wasted > kFineSteps && wasted > needed)
    fine_until_step_ = steps_done_ + static_cast<std::uint64_t>(setup_->config.imu.nominal_rate_hz);
  if (catching_up_ && late_ns > catching_.now_ns()) {
    // The second will meet it on its way; the first takes it in meanwhile where that is cheap.
    if (dear || marks_[at].after_step <= caught_up_step_) return;
  } else if (catching_up_ || dear) {
    if (!catching_up_) catching_for_ = 0;
    catching_up_ = true;
    catching_ = snapshot(at);
    if (past_.on()) catching_leg_ = legs_[marks_[at].place];
    caught_up_step_ = marks_[at].after_step;
    return;
  }
  repeated_steps_ += steps_done_ - marks_[at].after_step;
  steps_done_ = marks_[at].after_step;
  if (at > 0 && marks_[at].now_ns - marks_[at - 1].now_ns <= snapshot_interval_ns_ / kConsumedShare &&
      !is_awaited(marks_[at])) {
    // What it stood for has come: it becomes the present one instead of being copied.
    std::swap(present_, marks_[at].place);
    snapshot_count_ = at;
    return;
  }
  snapshot_count_ = at + 1;
  present() = snapshot(at);
  if (past_.on()) present_leg() = legs_[marks_[at].place];
}

TimeNs History::expected_behind(const Mark& mark) const {
  const ImuStep& next = steps_[mark.after_step % steps_.size()];
  return anticipation_.expected_until_ns(mark.now_ns, next.to_ns - next.from_ns);
}

bool History::is_awaited(const Mark& mark) const {
  return steps_done_ < fine_until_step_ || expected_behind(mark) != 0;
}

bool History::save_due(TimeNs newest_ns, TimeNs expected_until_ns) const {
  const Mark& last = marks_[snapshot_count_ - 1];
  const std::uint64_t steps = steps_done_ - last.after_step;
  if (steps >= steps_.size() / 4) return true;
  if (expected_until_ns > newest_ns && steps >= kNearSteps &&
      !goes_back_between(newest_ns, expected_until_ns))
    return true;
  const DurationNs since = present().now_ns() - last.now_ns;
  if (since >= snapshot_interval_ns_) return true;
  return steps_done_ < fine_until_step_ && steps >= kFineSteps &&
         since >= (newest_ns - present().now_ns()) / kSaveShare;
}

bool History::goes_back_between(TimeNs newest_ns, TimeNs until_ns) const {
  return std::any_of(marks_.begin(), marks_.begin() + static_cast<std::ptrdiff_t>(snapshot_count_),
                     [&](const Mark& one) {
                       if (one.kept_until_ns <= newest_ns)
                         return false;  // of most; what came meanwhile is not awaited
                       const TimeNs expected_ns = expected_behind(one);
                       return expected_ns > newest_ns && expected_ns <= until_ns;
                     });
}

void History::save(VerdictSink& sink, TimeNs kept_until_ns) {
  if (snapshot_count_ == marks_.size()) drop_snapshot(0);
  Mark& mark = marks_[snapshot_count_];
  mark.after_step = steps_done_;
  mark.now_ns = present().now_ns();
  mark.kept_until_ns = kept_until_ns;
  navigators_[mark.place] = present();
  if (past_.on()) legs_[mark.place] = present_leg();
  ++snapshot_count_;
  drop_before(oldest_ns(), sink);
}

void History::thin_snapshots(TimeNs newest_ns) {
  const TimeNs horizon = newest_ns - horizon_ns_;
  while (snapshot_count_ > 1 && marks_[1].now_ns < horizon) drop_snapshot(0);
  const DurationNs widest = snapshot_interval_ns_;
  for (std::size_t i = snapshot_count_; i-- > 2;) {
    const bool is_kept = marks_[i - 1].kept_until_ns >= newest_ns;
    if (is_kept && snapshot_count_ + kUnexpected < marks_.size()) continue;
    const TimeNs before = marks_[i - 2].now_ns;
    const DurationNs gap = marks_[i].now_ns - before;
    if (gap <= std::min(widest, (newest_ns - before) / kThinShare)) drop_snapshot(i - 1);
  }
}

void History::drop_snapshot(std::size_t age_order) {
  const auto mark = marks_.begin() + static_cast<std::ptrdiff_t>(age_order);
  std::rotate(mark, mark + 1, marks_.begin() + static_cast<std::ptrdiff_t>(snapshot_count_));
  --snapshot_count_;
}

}  // namespace fathom::estimation
