#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/time.hpp"
#include "bus/participant.hpp"

namespace fathom::bus::detail {

/// Counts every occurrence and reports the first of each kind × topic × subject. Subjects come from the
/// network: of a kind that has too many the further ones are counted only, and that is said once.
/// Thread-safe.
class EventBook {
 public:
  static constexpr std::size_t kMostOfAKind = 256;

  /// A deadline that is missed again within `quiet_ns` of its recovery is the same fault: it is counted, and
  /// not reported again. `now_ns` is a monotonic clock.
  explicit EventBook(DurationNs quiet_ns = 60 * kNsPerSecond, std::function<TimeNs()> now_ns = {});

  /// `subject` tells occurrences on the same topic apart: a peer, an instance.
  void report(BusEventKind kind, const std::string& topic, const std::string& subject,
              const std::string& detail, std::uint64_t occurrences = 1);
  /// Notes that the fault is over. When it stays away, its next occurrence is reported again.
  void recovered(BusEventKind kind, const std::string& topic, const std::string& subject);

  [[nodiscard]] BusCounters counters() const;
  void set_handler(std::function<void(const BusEvent&)> handler);

 private:
  /// When each reported fault was over; nothing while it lasts. By topic and subject.
  using Faults = std::map<std::pair<std::string, std::string>, std::optional<TimeNs>>;
  static constexpr std::size_t kBacklog = 64;  ///< kept for a handler that is set later

  /// Whether a fault that is over, and was for long enough, counts as new when it comes back.
  [[nodiscard]] bool is_past(BusEventKind kind, const std::optional<TimeNs>& over_ns) const;
  /// Forgets a fault that is past. False: there is none.
  bool forget_one(BusEventKind kind, Faults& faults) const;

  mutable std::mutex mutex_;  // of what follows up to the next mutex
  BusCounters counters_;
  std::map<BusEventKind, Faults> reported_;
  std::set<BusEventKind> overfull_;  // of which it was said that further ones are only counted
  DurationNs quiet_ns_;
  std::function<TimeNs()> now_ns_;

  std::mutex handler_mutex_;  // held while the handler runs; never taken while mutex_ is held
  std::function<void(const BusEvent&)> handler_;
  std::vector<BusEvent> backlog_;
};

}  // namespace fathom::bus::detail
