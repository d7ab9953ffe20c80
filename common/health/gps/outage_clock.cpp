#include "health/gps/outage_clock.hpp"

#include <algorithm>

#include "base/unknown.hpp"

namespace fathom::health {

void OutageClock::resume(const OutageRecord& record, TimeNs monotonic_ns) {
  ever_usable_ = true;
  active_ = record.active;
  resumed_ = true;
  resumed_ns_ = monotonic_ns;
  last_usable_ns_ = std::min(record.last_usable_ns, monotonic_ns);
  count_ = record.count;
  longest_ns_ = record.longest_ns;
  total_ns_ = record.total_ns;
  run_ = 0;
  evaluated_ns_ = std::max(evaluated_ns_, monotonic_ns);
}

void OutageClock::told(TimeNs last_usable_monotonic_ns) {
  if (known() || active_) return;
  last_usable_ns_ =
      ever_usable_ ? std::max(last_usable_ns_, last_usable_monotonic_ns) : last_usable_monotonic_ns;
  ever_usable_ = true;
  resumed_ = false;
}

void OutageClock::usable(TimeNs monotonic_ns) {
  if (resumed_ && !active_) {
    // Whether there was an outage meanwhile nobody can say: there is none now.
    last_usable_ns_ = std::max(last_usable_ns_, monotonic_ns);
  }
  resumed_ = false;
  if (!ever_usable_) {
    ever_usable_ = true;
    last_usable_ns_ = monotonic_ns;
    evaluated_ns_ = std::max(evaluated_ns_, monotonic_ns);
    return;
  }
  // The fix may be the first thing heard after a pause in which nobody evaluated.
  evaluate(monotonic_ns);
  if (!active_) {
    last_usable_ns_ = std::max(last_usable_ns_, monotonic_ns);
    return;
  }
  if (run_ == 0) run_begin_ns_ = monotonic_ns;
  ++run_;
  run_last_ns_ = monotonic_ns;
  end_if_regained();
}

void OutageClock::unusable() {
  run_ = 0;
}

void OutageClock::doubt(TimeNs since_monotonic_ns) {
  run_ = 0;
  if (!active_) last_usable_ns_ = std::min(last_usable_ns_, since_monotonic_ns);
}

void OutageClock::evaluate(TimeNs monotonic_ns) {
  evaluated_ns_ = std::max(evaluated_ns_, monotonic_ns);
  if (!ever_usable_) return;
  if (resumed_ && (active_ || evaluated_ns_ - resumed_ns_ >= from_seconds(limits_.limit_s))) resumed_ = false;
  if (resumed_) return;
  if (run_ > 0 && evaluated_ns_ - run_last_ns_ > from_seconds(limits_.limit_s)) run_ = 0;
  begin_if_due(evaluated_ns_);
  if (active_) longest_ns_ = std::max(longest_ns_, present_ns());
}

double OutageClock::now_s() const {
  if (!ever_usable_) return kUnknown;
  return active_ ? to_seconds(present_ns()) : 0.0;
}

double OutageClock::longest_s() const {
  return to_seconds(longest_ns_);
}

double OutageClock::total_s() const {
  return to_seconds(total_ns_ + (active_ ? present_ns() : 0));
}

DurationNs OutageClock::present_ns() const {
  return (run_ > 0 ? run_begin_ns_ : evaluated_ns_) - last_usable_ns_;
}

void OutageClock::begin_if_due(TimeNs monotonic_ns) {
  if (active_ || monotonic_ns - last_usable_ns_ < from_seconds(limits_.limit_s)) return;
  active_ = true;
  run_ = 0;
  ++count_;
}

void OutageClock::end_if_regained() {
  if (run_ < limits_.clear_fixes || run_last_ns_ - run_begin_ns_ < from_seconds(limits_.clear_hold_s)) return;
  longest_ns_ = std::max(longest_ns_, present_ns());
  total_ns_ += present_ns();
  active_ = false;
  last_usable_ns_ = run_last_ns_;
  run_ = 0;
}

}  // namespace fathom::health
