#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "base/few_at_once.hpp"
#include "base/time.hpp"
#include "runtime/log.hpp"

namespace fathom::runtime {

/// Which changes of a port's state are written. A few are written at once, each. Where there are many, as of
/// a plug with a loose contact, the newest one is written once a period, with how many there were: they fill
/// no disk. Thread-safe; the time is an argument.
class ChangeLog {
 public:
  struct Line {
    LogLevel level = LogLevel::info;
    std::string text;
  };

  /// The line to be written now, if any.
  [[nodiscard]] std::optional<Line> add(Line line, TimeNs monotonic_ns) {
    const std::lock_guard lock(mutex_);
    newest_ = std::move(line);
    ++unsaid_;
    return told(monotonic_ns);
  }
  /// What was held back and is to be written now. To be asked about once a second.
  [[nodiscard]] std::optional<Line> due(TimeNs monotonic_ns) {
    const std::lock_guard lock(mutex_);
    return unsaid_ > 0 ? told(monotonic_ns) : std::nullopt;
  }
  /// Something waits to be written.
  [[nodiscard]] bool holds() const {
    const std::lock_guard lock(mutex_);
    return unsaid_ > 0;
  }

 private:
  static constexpr DurationNs kPeriod_ns = 10 * kNsPerSecond;
  static constexpr int kFew = 8;

  std::optional<Line> told(TimeNs monotonic_ns) {
    if (!pace_.may_tell(monotonic_ns)) return std::nullopt;
    Line out = newest_;
    if (unsaid_ > 1) out.text += ", the last of " + std::to_string(unsaid_) + " changes";
    unsaid_ = 0;
    return out;
  }

  mutable std::mutex mutex_;
  FewAtOnce pace_{kFew, kPeriod_ns};
  std::uint64_t unsaid_ = 0;
  Line newest_;
};

}  // namespace fathom::runtime
