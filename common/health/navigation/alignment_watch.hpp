#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "health/alarm_book.hpp"
#include "health/freshness.hpp"
#include "health/instant.hpp"
#include "samples/alignment_status.hpp"
#include "samples/nav_state.hpp"

namespace fathom::health {

struct AlignmentWatchConfig {
  double limit_s = 180.0;      ///< no alignment this long after the first navigation state is an alarm
  double regain_hold_s = 2.0;  ///< how long a lost alignment must be back before the alarm clears
};

/// A watch over the alignment: whether attitude and position may be used, and if not, what is missing.
class AlignmentWatch {
 public:
  explicit AlignmentWatch(const AlignmentWatchConfig& config, Freshness fresh = {})
      : config_(config), fresh_(std::move(fresh)) {}

  void add(const AlignmentStatus& status, const Instant& now);
  /// The phase of the navigation state counts while such states come. The two topics do not arrive in one
  /// order, and a slightly older status must not look like a lost alignment.
  void add(const NavState& state, const Instant& now);
  /// Alarms "not_aligned" (for too long, or timed out), "alignment_lost" (after it was aligned),
  /// "implausible" (an instrument cannot be right: what the advice says), "noisy:<sensor>" (it scatters more
  /// than its sigmas say), "biased:<axis>" (of the inertial unit, by more than its sigma says). The last
  /// three hold until the service that said so counts as missing.
  void report(AlarmBook& book, const Instant& now) const;

  [[nodiscard]] AlignmentPhase phase() const { return phase_; }

 private:
  void phase(AlignmentPhase phase, const Instant& now);
  [[nodiscard]] std::string unmet() const;
  void report_noise(bool fresh, AlarmBook& book, const Instant& now) const;
  void report_biases(bool fresh, AlarmBook& book, const Instant& now) const;

  AlignmentWatchConfig config_;
  Freshness fresh_;
  bool heard_ = false;
  TimeNs heard_since_ns_ = 0;
  AlignmentPhase phase_ = AlignmentPhase::none;
  bool ever_aligned_ = false;
  TimeNs lost_since_ns_ = 0;
  AlignmentStatus last_;
  TimeNs last_ns_ = 0;                    ///< monotonic, of its arrival
  std::vector<Name> noisy_;               ///< sensors that were, once
  std::vector<std::string_view> biased_;  ///< axes that were, once
  bool last_known_ = false;
  bool nav_heard_ = false;
  TimeNs nav_heard_ns_ = 0;
};

}  // namespace fathom::health
