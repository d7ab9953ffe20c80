#pragma once

#include <optional>

#include "base/time.hpp"

namespace fathom {

/// Lets stamps through that go forward, for those whose readers must not see time go back. One that is a
/// little behind is of another service that has just been relieved; one that is further behind is of a clock
/// that was set.
class ForwardOnly {
 public:
  static constexpr DurationNs kClockWasSet_ns = 10 * kNsPerSecond;

  [[nodiscard]] bool takes(TimeNs stamp_ns) {
    if (newest_ns_ && stamp_ns <= *newest_ns_ && *newest_ns_ - stamp_ns < kClockWasSet_ns) return false;
    newest_ns_ = stamp_ns;
    return true;
  }

 private:
  std::optional<TimeNs> newest_ns_;
};

}  // namespace fathom
