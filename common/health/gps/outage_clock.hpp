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

/// The books of one source of fixes, in the form that outlives the process.
struct OutageRecord {
  bool active = false;
  TimeNs last_usable_ns = 0;  ///< on the clock of the record's owner
  std::uint32_t count = 0;
  DurationNs longest_ns = 0;
  DurationNs total_ns = 0;  ///< of the outages that have ended
};

/// A clock of outages: keeps the books of one source of fixes. All times are monotonic.
///
/// An outage lasts from the last usable fix before it to the first fix of the run that ended it. An unusable
/// fix, or a pause longer than `limit_s`, breaks a run. So single usable fixes inside an outage neither end
/// nor split it. The length of the outage stands still during a run. When the run breaks, the length counts
/// on as if there had been no run.
class OutageClock {
 public:
  explicit OutageClock(const OutageLimits& limits = {}) : limits_(limits) {}

  void usable(TimeNs monotonic_ns);
  /// A fix that must not be trusted, or a message without a fix.
  void unusable();
  /// Withdraws the usable fixes since then. Within an outage this only breaks the run.
  void doubt(TimeNs since_monotonic_ns);
  /// Begins and ends outages, as usable() does. Call it often.
  void evaluate(TimeNs monotonic_ns);

  /// Goes on from earlier books. What happened since is not known. Without an outage in the books, the first
  /// fix, told() or a silence of `limit_s` shows whether one has begun.
  void resume(const OutageRecord& record, TimeNs monotonic_ns);
  /// Takes over when somebody else had the last usable fix, where none arrived here.
  void told(TimeNs last_usable_monotonic_ns);
  [[nodiscard]] OutageRecord record() const {
    return {active_, last_usable_ns_, count_, longest_ns_, total_ns_};
  }
  /// Whether the present state is known: false before the first fix, and after resume() until something
  /// arrives.
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
  bool resumed_ = false;  ///< nothing arrived since resume()
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
