#pragma once

#include <array>
#include <cstdint>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "samples/status/health.hpp"

namespace fathom::health {

/// What is expected of a stream of messages.
struct StreamLimits {
  double expected_rate_hz = kUnknown;  ///< unknown: only the presence is watched
  double stale_s = 0.5;                ///< a stream that is silent this long is stale
  double missing_s = 2.0;              ///< a stream that is silent this long is missing
  int recover_samples = 3;  ///< messages in a row, less than `stale_s` apart, that make it present again

  /// Limits that suit a rate: stale after 3 periods (at least 0.5 s), missing after 10 periods (at least 2
  /// s), present again after a second's worth of samples (1 to 3).
  [[nodiscard]] static StreamLimits from_rate(double rate_hz);
};

/// Presence, age and rate of one stream, by arrival on the monotonic clock.
class StreamWatch {
 public:
  StreamWatch(const StreamLimits& limits, TimeNs start_monotonic_ns);

  void heard(TimeNs monotonic_ns);
  void evaluate(TimeNs monotonic_ns);

  [[nodiscard]] const StreamLimits& limits() const { return limits_; }
  [[nodiscard]] Presence presence() const { return presence_; }
  [[nodiscard]] bool ever_heard() const { return presence_ != Presence::never_seen; }
  /// Time since the last message, or since the start when there was none.
  [[nodiscard]] double silent_s(TimeNs monotonic_ns) const;
  /// The longest silence since the stream was present last, also while it comes back but is not trusted yet.
  [[nodiscard]] double outage_s(TimeNs monotonic_ns) const;
  /// Time since the last message; NaN when there was none.
  [[nodiscard]] double age_s(TimeNs monotonic_ns) const;
  /// Rate over the last seconds (longer for slow streams); NaN until enough messages arrived.
  [[nodiscard]] double rate_hz(TimeNs monotonic_ns) const;
  /// Whether a present stream had less than half the expected rate for a whole window. It stays slow until
  /// the rate is above 70 % again.
  [[nodiscard]] bool slow() const { return slow_; }

 private:
  static constexpr int kBuckets = 10;
  [[nodiscard]] std::int64_t bucket_of(TimeNs monotonic_ns) const;

  StreamLimits limits_;
  TimeNs start_ns_;
  TimeNs last_ns_;
  TimeNs first_ns_ = 0;
  TimeNs present_since_ns_ = 0;
  Presence presence_ = Presence::never_seen;
  int run_ = 0;
  DurationNs outage_ns_ = 0;  ///< the longest silence that ended since the stream was present last
  bool slow_ = false;
  DurationNs bucket_ns_;
  std::array<std::int64_t, kBuckets> bucket_id_{};
  std::array<std::uint32_t, kBuckets> bucket_count_{};
};

}  // namespace fathom::health
