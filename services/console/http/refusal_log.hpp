#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "base/time.hpp"
#include "console/http/request.hpp"

namespace fathom::console {

/// One line per kind of refusal and period, with how many there were: whoever floods the console fills no
/// disk. Thread-safe; the time is an argument.
class RefusalLog {
 public:
  /// `what` is refused, e.g. "a request".
  RefusalLog(DurationNs period_ns, std::string what) : period_ns_(period_ns), what_(std::move(what)) {}

  /// The line to be written, if any; a status of 0 is left out. Reasons come from the console itself, so
  /// there are few.
  [[nodiscard]] std::optional<std::string> add(const Refusal& refusal, const std::string& peer,
                                               TimeNs monotonic_ns) {
    const std::lock_guard lock(mutex_);
    Entry& entry = entries_[refusal.reason];
    ++entry.unsaid;
    if (entry.said_ns && monotonic_ns - *entry.said_ns < period_ns_) return std::nullopt;
    std::string line = "refused " + what_ + " from " + peer + ": " + refusal.reason;
    if (refusal.status != 0) line += " (" + std::to_string(refusal.status) + ")";
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
  std::string what_;
  std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

}  // namespace fathom::console
