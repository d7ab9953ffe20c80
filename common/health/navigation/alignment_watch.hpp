#pragma once

#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "samples/alignment_status.hpp"
#include "samples/nav_state.hpp"

namespace fathom::health {

struct AlignmentWatchConfig {
  double limit_s = 180.0;      ///< not aligned this long after navigation was first heard of: an alarm
  double regain_hold_s = 2.0;  ///< a lost alignment must be back this long before the alarm clears
};

/// Whether attitude and position may be used, and if not, what is waited for.
class AlignmentWatch {
 public:
  explicit AlignmentWatch(const AlignmentWatchConfig& config) : config_(config) {}

  void add(const AlignmentStatus& status, const Instant& now);
  /// While navigation states come their phase is the one that counts: two topics do not arrive in one order,
  /// and a status that is a moment older must not look like an alignment lost.
  void add(const NavState& state, const Instant& now);
  /// "not_aligned" (too long, or timed out), "alignment_lost" (was aligned before).
  void report(AlarmBook& book, const Instant& now) const;

  [[nodiscard]] AlignmentPhase phase() const { return phase_; }

 private:
  void phase(AlignmentPhase phase, const Instant& now);
  [[nodiscard]] std::string unmet() const;

  AlignmentWatchConfig config_;
  bool heard_ = false;
  TimeNs heard_since_ns_ = 0;
  AlignmentPhase phase_ = AlignmentPhase::none;
  bool ever_aligned_ = false;
  TimeNs lost_since_ns_ = 0;
  AlignmentStatus last_;
  bool last_known_ = false;
  bool nav_heard_ = false;
  TimeNs nav_heard_ns_ = 0;
};

}  // namespace fathom::health
