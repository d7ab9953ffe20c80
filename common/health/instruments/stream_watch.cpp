#include "health/instruments/stream_watch.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::health {

StreamLimits StreamLimits::from_rate(double rate_hz) {
  StreamLimits limits;
  limits.expected_rate_hz = rate_hz;
  limits.stale_s = std::max(0.5, 3.0 / rate_hz);
  limits.missing_s = std::max(2.0, 10.0 / rate_hz);
  limits.recover_samples = std::clamp(static_cast<int>(rate_hz), 1, 3);
  return limits;
}

StreamWatch::StreamWatch(const StreamLimits& limits, TimeNs start_monotonic_ns)
    : limits_(limits), start_ns_(start_monotonic_ns), last_ns_(start_monotonic_ns) {
  // The window spans at least four expected messages, so that a slow stream's rate is not 0 or 1 per window.
  const double window_s =
      std::isfinite(limits.expected_rate_hz) ? std::max(5.0, 4.0 / limits.expected_rate_hz) : 5.0;
  bucket_ns_ = from_seconds(window_s / kBuckets);
  bucket_id_.fill(-1);
}

void StreamWatch::heard(TimeNs monotonic_ns) {
  evaluate(monotonic_ns);
  if (presence_ == Presence::never_seen) {
    first_ns_ = monotonic_ns;
    present_since_ns_ = monotonic_ns;
    presence_ = Presence::present;
  } else {
    run_ = to_seconds(monotonic_ns - last_ns_) <= limits_.stale_s ? run_ + 1 : 1;
    outage_ns_ = presence_ == Presence::present ? 0 : std::max(outage_ns_, monotonic_ns - last_ns_);
    if (presence_ != Presence::present && run_ >= limits_.recover_samples) {
      presence_ = Presence::present;
      present_since_ns_ = monotonic_ns;
    }
  }
  last_ns_ = std::max(last_ns_, monotonic_ns);
  const std::int64_t id = bucket_of(monotonic_ns);
  const auto slot = static_cast<std::size_t>(id % kBuckets);
  if (bucket_id_[slot] != id) {
    bucket_id_[slot] = id;
    bucket_count_[slot] = 0;
  }
  ++bucket_count_[slot];
}

void StreamWatch::evaluate(TimeNs monotonic_ns) {
  if (presence_ == Presence::never_seen) return;
  const double age = age_s(monotonic_ns);
  if (age > limits_.missing_s) {
    presence_ = Presence::missing;
  } else if (age > limits_.stale_s && presence_ == Presence::present) {
    presence_ = Presence::stale;
  }
  if (presence_ != Presence::present) {
    slow_ = false;
    return;
  }
  // Judged over full windows only: neither the first seconds nor those after a gap are slow.
  const double rate = rate_hz(monotonic_ns);
  const bool whole_window = monotonic_ns - present_since_ns_ > kBuckets * bucket_ns_;
  if (!std::isfinite(limits_.expected_rate_hz) || !std::isfinite(rate) || !whole_window) return;
  slow_ = rate < (slow_ ? 0.7 : 0.5) * limits_.expected_rate_hz;
}

double StreamWatch::silent_s(TimeNs monotonic_ns) const {
  return to_seconds(std::max<DurationNs>(0, monotonic_ns - last_ns_));
}

double StreamWatch::outage_s(TimeNs monotonic_ns) const {
  const double ended_s = presence_ == Presence::present ? 0.0 : to_seconds(outage_ns_);
  return std::max(ended_s, silent_s(monotonic_ns));
}

double StreamWatch::age_s(TimeNs monotonic_ns) const {
  return ever_heard() ? silent_s(monotonic_ns) : kUnknown;
}

double StreamWatch::rate_hz(TimeNs monotonic_ns) const {
  if (!ever_heard()) return kUnknown;
  const std::int64_t newest = bucket_of(monotonic_ns);
  std::uint64_t count = 0;
  for (int i = 0; i < kBuckets; ++i) {
    const auto slot = static_cast<std::size_t>(i);
    if (bucket_id_[slot] > newest - kBuckets && bucket_id_[slot] <= newest) count += bucket_count_[slot];
  }
  const TimeNs window_begin = start_ns_ + (newest - kBuckets + 1) * bucket_ns_;
  const DurationNs span = monotonic_ns - std::max(window_begin, first_ns_);
  if (span < bucket_ns_) return kUnknown;
  // The first message opens the span and is not part of what followed in it.
  const std::uint64_t counted = first_ns_ >= window_begin && count > 0 ? count - 1 : count;
  return static_cast<double>(counted) / to_seconds(span);
}

std::int64_t StreamWatch::bucket_of(TimeNs monotonic_ns) const {
  return std::max<TimeNs>(0, monotonic_ns - start_ns_) / bucket_ns_;
}

}  // namespace fathom::health
