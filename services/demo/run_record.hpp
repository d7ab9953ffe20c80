#pragma once

#include <deque>

#include "demo/observation.hpp"
#include "samples/gps.hpp"
#include "samples/truth.hpp"

namespace fathom::demo {

/// The book of one run: what was heard goes in, an observation comes out. Pure: time is an argument. Vehicle
/// UTC and the vehicle's monotonic time, both in ns.
class RunRecord {
 public:
  struct Options {
    double gps_limit_s = 5.0;      ///< of the monitor
    double degraded_hold_s = 5.0;  ///< of the monitor
    double score_from_s = 0.0;     ///< earlier navigation states are not scored
    TimeNs ends_ns = 0;            ///< a recording has nothing later than this; 0: no end of its own
  };
  RunRecord(const Options& options, TimeNs began_ns);

  /// `latency_us`: from the arrival of the inertial sample to the arrival of the state here, host time.
  void add(const NavState& state, double latency_us);
  void add(const Truth& row);
  void add(const GpsSample& sample);
  void add(const MonitorStatus& status);
  void add(const ServiceStatus& status, TimeNs monotonic_ns);
  void add(const AlignmentStatus& status);
  void add(const Verdict& verdict);
  void add(const Alarm& alarm);

  /// `utc_ns`, `monotonic_ns`: now. What is missing until now is part of the answer.
  [[nodiscard]] Observation look(TimeNs utc_ns, TimeNs monotonic_ns) const;

 private:
  [[nodiscard]] double since_began_s(TimeNs stamp_ns) const;
  /// Whether `until_ns` is later after the last usable fix than the monitor's limit.
  [[nodiscard]] bool silent_longer_than_limit(TimeNs until_ns) const;

  Options options_;
  Observation seen_;
  dataset::TruthTrack truth_;
  std::deque<NavState> to_score_;  ///< ten a second, until the truth has passed them
  dataset::Scorer scorer_;
  TimeNs last_scored_ns_ = 0;
  std::size_t next_latency_ = 0;
  TimeNs last_usable_fix_ns_ = 0;
  bool flagged_ = false;
};

}  // namespace fathom::demo
