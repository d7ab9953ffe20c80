#pragma once

#include "base/time.hpp"

namespace fathom {

/// What a service calls "now": UTC in nanoseconds and a monotonic count that no clock step moves.
/// Services hold a reference; the pure core never does (time is an argument there).
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual TimeNs utc_ns() const = 0;
  [[nodiscard]] virtual TimeNs monotonic_ns() const = 0;
  /// Vehicle seconds per host second: 1 on a vehicle, other values in accelerated replays.
  [[nodiscard]] virtual double rate() const { return 1.0; }
};

/// The host's own clocks.
class SystemClock : public Clock {
 public:
  [[nodiscard]] TimeNs utc_ns() const override;
  [[nodiscard]] TimeNs monotonic_ns() const override;
  /// Monotonic, and it goes on while the host sleeps.
  [[nodiscard]] TimeNs boottime_ns() const;
};

/// UTC as it was at an instant, carried on by the monotonic clock: who sets the host's UTC afterwards moves
/// no stamp. Slewing (chrony, ptp4l) is followed, as the kernel slews both clocks.
class AnchoredClock : public SystemClock {
 public:
  explicit AnchoredClock(DurationNs utc_minus_monotonic_ns) : offset_ns_(utc_minus_monotonic_ns) {}
  [[nodiscard]] TimeNs utc_ns() const override { return monotonic_ns() + offset_ns_; }

 private:
  DurationNs offset_ns_;
};

/// Runs `rate` times as fast as the host from `epoch_utc_ns` on. All services of an accelerated demo are
/// given the same epoch and rate, so that their stamps, timeouts and outage clocks agree with each other.
class ScaledClock : public Clock {
 public:
  /// Precondition: rate > 0.
  ScaledClock(TimeNs epoch_utc_ns, double rate);
  [[nodiscard]] TimeNs utc_ns() const override;
  [[nodiscard]] TimeNs monotonic_ns() const override;
  [[nodiscard]] double rate() const override { return rate_; }

 private:
  TimeNs epoch_utc_ns_;
  TimeNs epoch_monotonic_ns_;
  double rate_;
};

/// A clock that stands still until told otherwise, for tests.
class ManualClock : public Clock {
 public:
  explicit ManualClock(TimeNs utc = 0) : utc_(utc) {}
  [[nodiscard]] TimeNs utc_ns() const override { return utc_; }
  [[nodiscard]] TimeNs monotonic_ns() const override { return monotonic_; }
  void advance(DurationNs by) {
    utc_ += by;
    monotonic_ += by;
  }
  /// A step of UTC alone, as when a time server corrects the host.
  void step_utc(DurationNs by) { utc_ += by; }

 private:
  TimeNs utc_;
  TimeNs monotonic_ = 0;
};

}  // namespace fathom
