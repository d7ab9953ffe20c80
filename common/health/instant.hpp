#pragma once

#include "base/time.hpp"

namespace fathom::health {

/// "Now" as the health classes are told it: durations are measured on the monotonic count only; UTC, of the
/// vehicle's clock that nobody sets (AnchoredClock), is for what people and other services read.
struct Instant {
  TimeNs monotonic_ns = 0;
  TimeNs utc_ns = 0;
};

}  // namespace fathom::health
