#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "base/time.hpp"

namespace fathom::runtime {

/// One line per reason and period, with how many there were: whoever floods a service fills no disk.
/// Thread-safe; the time is an argument.
class RefusalLog {
 public:
  explicit RefusalLog(DurationNs period_ns = 10 * kNsPerSecond) : period_ns_(period_ns) {}

  /// The line to be written, if any. Reasons come from the service itself, so there are few.
  [[nodiscard]] std::optional<std::string> add(const std::string& reason, std::string line,
                                               TimeNs monotonic_ns) {
    const std::lock_guard lock(mutex_);
    Entry& entry = entries_[reason];
    ++entry.unsaid;
    if (entry.said_ns && monotonic_ns - *entry.said_ns < period_ns_) return std::nullopt;
    if (entry.unsaid > 1) line += ", " + std::to_string(entry.unsaid) + " of them since it was last said";
    entry.said_ns = monotonic_ns;
    entry.unsaid = 0;
    return line;
  }

 private:
  struct Entry {
    std::optional<TimeNs> said_ns;
    std::uint64_t unsaid = 0;
  };
  DurationNs period_ns_;
  std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

}  // namespace fathom::runtime
