#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>

namespace fathom::bus::detail {

/// The pace at which a reader takes samples while lost ones are sent again.
///
/// A take of Fast DDS 2.9.1 that finds nothing has looked at every sample that waits for a lost one before
/// it, some microseconds each. After a cut hundreds wait, and each sample that is sent again calls for a
/// take. On a busy machine the reader would take more slowly than samples arrive, more and more of them would
/// wait, and in the end the writer would no longer have what the reader lacks. So the reader rests after a
/// take that took long to find nothing, and then takes all that came meanwhile. Thread-safe.
class TakePace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Whether nothing is to be taken now. Whoever began the rest takes when it is over.
  [[nodiscard]] bool rests(Time now) const { return now < until_.load(); }

  /// A take found nothing. Returns for how long the reader rests; 0: not at all.
  std::chrono::milliseconds found_nothing(Time began, Time now) {
    constexpr int kTimesAsLong = 5;
    constexpr std::chrono::milliseconds kLongest(50);
    using std::chrono::milliseconds;
    const auto rest =
        std::min(std::chrono::duration_cast<milliseconds>(kTimesAsLong * (now - began)), kLongest);
    if (rest > milliseconds(0)) until_ = now + rest;
    return rest;
  }

 private:
  std::atomic<Time> until_{};
};

}  // namespace fathom::bus::detail
