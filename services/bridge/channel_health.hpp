#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "base/time.hpp"
#include "runtime/byte_source.hpp"

namespace fathom::bridge {

/// What an instrument has delivered so far.
struct ChannelTotals {
  runtime::SourceState state = runtime::SourceState::lost;
  std::string detail;  ///< of the source
  std::uint64_t bytes = 0;
  std::uint64_t waste_bytes = 0;  ///< between frames and inside refused ones
  std::uint64_t samples = 0;
  std::optional<TimeNs> last_sample_ns;  ///< monotonic
};

/// Judges one instrument from what it delivers. Pure: time is an argument.
class ChannelHealth {
 public:
  /// `rate_hz` 0: any rate is right. `now_ns`: monotonic time of the start; until stale_after_s later a
  /// missing sample is no problem yet, nor until first_sample_s where that is longer and the source is open.
  ChannelHealth(double rate_hz, double stale_after_s, double first_sample_s, TimeNs now_ns);

  /// What is wrong, in words for the service's status; nothing when all is well. Call about once a second.
  [[nodiscard]] std::optional<std::string> judge(const ChannelTotals& totals, TimeNs now_ns);

  /// Samples per second over the last seconds (ten periods of a slow instrument); NaN before there is a span.
  [[nodiscard]] double rate_hz() const;

 private:
  struct Mark {
    TimeNs at_ns;
    std::uint64_t bytes;
    std::uint64_t waste;
    std::uint64_t samples;
  };
  double rate_hz_;
  double stale_after_s_;
  double first_sample_s_;
  double window_s_;
  TimeNs start_ns_;
  std::deque<Mark> marks_;
};

}  // namespace fathom::bridge
