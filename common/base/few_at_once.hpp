#pragma once

#include <optional>
#include <utility>

#include "base/time.hpp"

namespace fathom {

/// What is told of things that happen again and again: a few at once, each; of many, one a period, so that
/// they fill no disk. Not thread-safe; the time is an argument.
class FewAtOnce {
 public:
  FewAtOnce(int few, DurationNs period_ns) : few_(few), period_ns_(period_ns) {}

  /// Whether what happened is told now; else it is held back, and to be asked about again.
  [[nodiscard]] bool may_tell(TimeNs monotonic_ns) {
    if (!begin_ns_ || monotonic_ns - *begin_ns_ >= period_ns_) {
      begin_ns_ = monotonic_ns;
      told_ = std::exchange(held_, false) ? few_ - 1 : 0;
    }
    held_ = told_ >= few_;
    if (!held_) ++told_;
    return !held_;
  }

 private:
  int few_;
  DurationNs period_ns_;
  std::optional<TimeNs> begin_ns_;
  int told_ = 0;
  bool held_ = false;  ///< something, since the period began
};

}  // namespace fathom
