#include "base/clock.hpp"

#include <chrono>
#include <cmath>
#include <ctime>

namespace fathom {

TimeNs SystemClock::utc_ns() const {
  using std::chrono::duration_cast;
  return duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

TimeNs SystemClock::monotonic_ns() const {
  using std::chrono::duration_cast;
  return duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

TimeNs SystemClock::boottime_ns() const {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return now.tv_sec * kNsPerSecond + now.tv_nsec;
}

ScaledClock::ScaledClock(TimeNs epoch_utc_ns, double rate) : epoch_utc_ns_(epoch_utc_ns), rate_(rate) {
  // Several processes share one epoch, so the anchor on the monotonic clock is derived from it, not from
  // "now".
  const SystemClock host;
  epoch_monotonic_ns_ = host.monotonic_ns() - (host.utc_ns() - epoch_utc_ns);
}

TimeNs ScaledClock::utc_ns() const {
  const SystemClock host;
  return epoch_utc_ns_ + std::llround(static_cast<double>(host.monotonic_ns() - epoch_monotonic_ns_) * rate_);
}

TimeNs ScaledClock::monotonic_ns() const {
  const SystemClock host;
  return std::llround(static_cast<double>(host.monotonic_ns() - epoch_monotonic_ns_) * rate_);
}

}  // namespace fathom
