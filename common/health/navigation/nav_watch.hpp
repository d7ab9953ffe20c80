#pragma once

#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "health/instruments/stream_watch.hpp"
#include "samples/nav_state.hpp"

namespace fathom::health {

struct NavWatchConfig {
  bool expected = true;
  double rate_hz = 100.0;              ///< of the navigation state
  double missing_s = 1.0;              ///< a state that is missing this long is an alarm
  double horizontal_95_limit_m = 100;  ///< a larger 95 % radius is an alarm, until it is 10 % below the limit
};

/// A watch over the navigation state as guidance sees it: present, in time, finite and certain enough. A
/// state with the same stamp as the state before it is no sign of life.
class NavWatch {
 public:
  NavWatch(const NavWatchConfig& config, double startup_s, const Instant& start);

  void add(const NavState& state, const Instant& now);
  void evaluate(const Instant& now);
  [[nodiscard]] bool ever_heard() const { return stream_.ever_heard(); }
  /// "nav_state_missing", "nav_state_slow", "nav_state_invalid", "nav_uncertain".
  void report(AlarmBook& book, const Instant& now) const;

  /// The mode of the last state, or none while the state is missing.
  [[nodiscard]] NavMode mode() const;
  [[nodiscard]] double age_s(const Instant& now) const { return stream_.age_s(now.monotonic_ns); }
  /// The 95 % radius; NaN while the state is missing or has no position.
  [[nodiscard]] double horizontal_95_m() const;
  [[nodiscard]] bool fresh() const { return stream_.presence() == Presence::present; }

 private:
  NavWatchConfig config_;
  double startup_s_;
  StreamWatch stream_;
  TimeNs last_stamp_ns_ = 0;
  NavMode mode_ = NavMode::none;
  bool invalid_ = false;
  double horizontal_95_m_ = kUnknown;
  bool uncertain_ = false;
};

}  // namespace fathom::health
