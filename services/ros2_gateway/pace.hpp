#pragma once

#include <algorithm>

#include "base/time.hpp"

namespace fathom::ros2_gateway {

/// Lets through at most so many a second, by their stamps, evenly.
class Pace {
 public:
  /// 0: all.
  explicit Pace(double rate_hz) : period_ns_(rate_hz > 0.0 ? from_seconds(1.0 / rate_hz) : 0) {}

  [[nodiscard]] bool is_due(TimeNs stamp_ns) {
    if (period_ns_ == 0) return true;
    if (stamp_ns < next_ns_) return false;
    next_ns_ = std::max(next_ns_ + period_ns_, stamp_ns + period_ns_ / 2);
    return true;
  }
  void begin_anew() { next_ns_ = 0; }

 private:
  DurationNs period_ns_;
  TimeNs next_ns_ = 0;
};

/// Time never goes backwards for those who read: states that are not later than the last one are left out, as
/// after a takeover by a service that is a little behind. Where for a while nothing else comes, time was set
/// back, and begins anew.
class OneWay {
 public:
  static constexpr DurationNs kPatience_ns = 5 * kNsPerSecond;

  enum class Step { forward, back, anew };

  /// `now_ns` is a monotonic clock.
  [[nodiscard]] Step step(TimeNs stamp_ns, TimeNs now_ns) {
    if (stamp_ns > last_ns_) {
      last_ns_ = stamp_ns;
      back_since_ns_ = 0;
      return Step::forward;
    }
    if (back_since_ns_ == 0) back_since_ns_ = now_ns;
    if (now_ns - back_since_ns_ < kPatience_ns) return Step::back;
    last_ns_ = stamp_ns;
    back_since_ns_ = 0;
    return Step::anew;
  }

 private:
  TimeNs last_ns_ = 0;
  TimeNs back_since_ns_ = 0;  // monotonic; 0: it does not go back
};

}  // namespace fathom::ros2_gateway
