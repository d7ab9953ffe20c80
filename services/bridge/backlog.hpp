#pragma once

#include <cstddef>
#include <optional>

#include "base/time.hpp"

namespace fathom::bridge {

/// Samples of one kind that an instrument without a clock of its own has sent, and that are stamped by their
/// arrival. While the bridge is held up they gather, and are then read at once: they did not arrive at once.
/// Pure: time is an argument.
class Backlog {
 public:
  /// `rate_hz`: of the instrument; 0: unknown, and nothing is told apart.
  explicit Backlog(double rate_hz) : period_ns_(rate_hz > 0.0 ? from_seconds(1.0 / rate_hz) : 0) {}

  /// `count` samples were read at `now_ns` (monotonic): how far apart they arrived, the last of them now. One
  /// period when as many were due since the read before; else 0, as the instrument itself sent them together.
  [[nodiscard]] DurationNs spacing(std::size_t count, TimeNs now_ns) {
    const auto since_ns = before_ns_ ? std::optional(now_ns - *before_ns_) : std::nullopt;
    before_ns_ = now_ns;
    if (count < 2 || !since_ns) return 0;
    const auto periods = static_cast<DurationNs>(count);
    return 2 * *since_ns >= (2 * periods - 1) * period_ns_ ? period_ns_ : 0;
  }
  /// What comes next is of a new connection, made at `now_ns`: nothing gathered before.
  void begin(TimeNs now_ns) { before_ns_ = now_ns; }

 private:
  DurationNs period_ns_;
  std::optional<TimeNs> before_ns_;
};

}  // namespace fathom::bridge
