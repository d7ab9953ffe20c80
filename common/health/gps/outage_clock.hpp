#pragma once

#include <cstdint>

#include "base/time.hpp"

namespace fathom::health {

/// When fixes count as lost and as regained.
struct OutageLimits {
  double limit_s = 5.0;       ///< an outage begins when there was no usable fix for this long
  int clear_fixes = 3;        ///< it ends after this many usable fixes in a row ...
  double clear_hold_s = 1.0;  ///< ... spread over at least this long
};

/// The books of one source of fixes, as they outlive the process that kept them.
struct OutageRecord {
  bool active = false;
  TimeNs last_usable_ns = 0;  ///< on the clock of whoever holds the record
  std::uint32_t count = 0;
  DurationNs longest_ns = 0;
  DurationNs total_ns = 0;  ///< of the outages that have ended
};

/// Keeps the books of one source of fixes. All times are monotonic.
///
/// An outage is counted from the last usable fix before it to the first fix of the run that ended it. A run
/// is broken by an unusable fix or by a pause longer than `limit_s`; single usable fixes inside an outage
/// therefore neither end nor split it. While a run is under way the outage's length stands still; when the
/// run breaks it counts on as if the run had not been.
class OutageClock {
 public:
  explicit OutageClock(const OutageLimits& limits = {}) : limits_(limits) {}

  void usable(TimeNs monotonic_ns);
  /// A fix that must not be trusted, or a message without a fix.
  void unusable();
  /// What was usable since then was not: fixes are counted from there. Within an outage it only breaks the
  /// run.
  void doubt(TimeNs since_monotonic_ns);
  /// To be called often: outages begin and end here and in usable().
  void evaluate(TimeNs monotonic_ns);

  /// Goes on from books of before. What happened since their last line is not known: without an outage in
  /// them the first fix, told() or a silence of `limit_s` says whether one has begun.
  void resume(const OutageRecord& record, TimeNs monotonic_ns);
  /// Somebody else heard the last usable fix then. Counts where nothing was heard here.
  void told(TimeNs last_usable_monotonic_ns);
  [[nodiscard]] OutageRecord record() const {
    return {active_, last_usable_ns_, count_, longest_ns_, total_ns_};
  }
  /// Whether it can say anything about now: false before the first fix, and after resume() until something is
  /// heard.
  [[nodiscard]] bool known() const { return ever_usable_ && !resumed_; }

  [[nodiscard]] bool ever_usable() const { return ever_usable_; }
  [[nodiscard]] bool active() const { return active_; }
  /// The last usable fix; during an outage the one before it.
  [[nodiscard]] TimeNs last_usable_ns() const { return last_usable_ns_; }
  /// Length of the present outage, 0 when there is none, NaN before the first usable fix. As of evaluate().
  [[nodiscard]] double now_s() const;
  [[nodiscard]] double longest_s() const;
  [[nodiscard]] double total_s() const;
  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  [[nodiscard]] DurationNs present_ns() const;
  void begin_if_due(TimeNs monotonic_ns);
  void end_if_regained();

  OutageLimits limits_;
  bool ever_usable_ = false;
  bool active_ = false;
  bool resumed_ = false;  ///< and nothing heard since
  TimeNs resumed_ns_ = 0;
  TimeNs last_usable_ns_ = 0;  ///< before the outage, while there is one
  TimeNs evaluated_ns_ = 0;
  int run_ = 0;  ///< usable fixes in a row since the outage began
  TimeNs run_begin_ns_ = 0;
  TimeNs run_last_ns_ = 0;
  std::uint32_t count_ = 0;
  DurationNs longest_ns_ = 0;
  DurationNs total_ns_ = 0;
};

}  // namespace fathom::health
