#pragma once

#include "base/time.hpp"

namespace fathom::health {

/// An instant on two clocks. Durations are measured with the monotonic one only. UTC comes from the vehicle's
/// clock, which nobody sets (AnchoredClock), and is for people and other services.
struct Instant {
  TimeNs monotonic_ns = 0;
  TimeNs utc_ns = 0;
};

}  // namespace fathom::health
