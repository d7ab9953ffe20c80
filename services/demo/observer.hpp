#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "bus/participant.hpp"
#include "dataset/score.hpp"
#include "samples/alignment_status.hpp"
#include "samples/gps.hpp"
#include "samples/health.hpp"
#include "samples/nav_state.hpp"
#include "samples/truth.hpp"
#include "samples/verdict.hpp"

namespace fathom::demo {

/// A time without a usable GPS fix that was longer than the monitor's limit. Seconds since the run began.
struct GpsOutage {
  double start_s = 0.0;               ///< last usable fix before it
  double end_s = kUnknown;            ///< first usable fix after it; unknown while it lasts
  double flagged_after_s = kUnknown;  ///< from start_s to the monitor's flag
  double cleared_after_s = kUnknown;  ///< from end_s to the monitor's all-clear
};

/// What one service said of itself during the run.
struct ServiceRecord {
  ServiceState state = ServiceState::starting;
  TimeNs last_heard_ns = 0;
  bool was_healthy = false;
  TimeNs degraded_since_ns = 0;  ///< monotonic; 0: it is not
  bool fell = false;             ///< was healthy and then degraded for longer than a stumble
  std::string text;              ///< the last reason for not being healthy
};

/// Everything observed so far; a copy, so that nobody holds the observer's lock while writing it down.
struct Observation {
  TimeNs began_ns = 0;
  std::uint64_t nav_states = 0;
  TimeNs first_nav_ns = 0;
  TimeNs last_nav_ns = 0;
  std::optional<NavState> nav;
  std::optional<MonitorStatus> monitor;
  std::optional<AlignmentStatus> alignment;
  TimeNs truth_began_ns = 0;  ///< the first row of the truth: 0 until there is one
  TimeNs aligned_ns = 0;      ///< stamp of the first status that said aligned: 0 until there is one
  std::map<std::string, ServiceRecord> services;
  std::map<std::string, std::array<std::uint64_t, kVerdictKinds>> verdicts;
  std::map<std::string, Alarm> alarms;  ///< every alarm seen, in its last state
  std::vector<GpsOutage> outages;
  dataset::Score score;
  double distance_m = 0.0;
  std::optional<dataset::NavError> error;  ///< the newest that the truth allows
  double latency_p50_us =
      kUnknown;  ///< arrival of the inertial sample at its bridge -> navigation state received
  double latency_p99_us = kUnknown;

  /// From the vehicle's beginning to aligned; unknown while it is not. What the services take to start before
  /// the first instrument speaks is not the vehicle's.
  [[nodiscard]] double aligned_after_s() const;
};

/// Listens to the whole vehicle network, as a guidance program and a referee with the truth would.
class Observer {
 public:
  struct Options {
    double gps_limit_s = 5.0;      ///< of the monitor
    double degraded_hold_s = 5.0;  ///< of the monitor
    double score_from_s = 0.0;     ///< earlier navigation states are not scored
  };
  /// `clock` must outlive the observer. Throws bus::BusError.
  Observer(bus::Participant& participant, const Clock& clock, const Options& options);
  ~Observer();

  [[nodiscard]] Observation look() const;

 private:
  struct Readers;

  void on_nav(const NavState& state);
  void on_truth(const Truth& row);
  void on_gps(const GpsSample& sample);
  void on_monitor(const MonitorStatus& status);
  void on_service(const ServiceStatus& status);
  [[nodiscard]] double since_began_s(TimeNs stamp_ns) const;

  const Clock& clock_;
  Options options_;
  mutable std::mutex mutex_;
  Observation seen_;
  dataset::TruthTrack truth_;
  std::deque<NavState> to_score_;  ///< ten a second, until the truth has passed them
  dataset::Scorer scorer_;
  TimeNs last_scored_ns_ = 0;
  std::vector<float> latencies_us_;  ///< the newest kLatencies
  std::size_t next_latency_ = 0;
  TimeNs last_usable_fix_ns_ = 0;
  bool flagged_ = false;
  std::unique_ptr<Readers> readers_;  ///< last: gone before what its handlers touch
};

}  // namespace fathom::demo
