#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "dataset/score.hpp"
#include "samples/alignment_status.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/verdict.hpp"

namespace fathom::demo {

/// A time without a usable GPS fix that was longer than the monitor's limit. Seconds since the run began.
struct GpsOutage {
  double start_s = 0.0;               ///< last usable fix before it
  double end_s = kUnknown;            ///< first usable fix after it; unknown while it lasts
  double flagged_after_s = kUnknown;  ///< from start_s to the monitor's flag
  double cleared_after_s = kUnknown;  ///< from end_s to the monitor's all-clear
  bool cleared_without_fix = false;   ///< the monitor gave the all-clear before there was a usable fix
};

/// What one service said of itself during the run.
struct ServiceRecord {
  ServiceState state = ServiceState::starting;
  TimeNs last_heard_ns = 0;
  bool was_healthy = false;
  TimeNs degraded_since_ns = 0;  ///< monotonic; 0: it is not
  bool fell = false;             ///< was healthy and then degraded for longer than a stumble
  double longest_silence_s = 0;  ///< between two life signs, or since the last one
  std::string text;              ///< the last reason for not being healthy
};

/// Everything observed so far; a copy, so that nobody holds the observer's lock while writing it down.
struct Observation {
  TimeNs began_ns = 0;
  TimeNs ended_ns = 0;           ///< of what the vehicle does: now, or the end of a recording before that
  std::uint64_t nav_states = 0;  ///< each later than the one before it; repeated ones do not count
  std::uint64_t valid_states =
      0;  ///< of them, those with a position, velocity and attitude, from score_from_s on
  std::uint64_t states_since_valid = 0;  ///< all from the first of the valid ones on
  TimeNs first_valid_ns = 0;             ///< the first of them: 0 until there is one
  TimeNs first_nav_ns = 0;
  TimeNs last_nav_ns = 0;
  std::optional<NavState> nav;
  std::optional<MonitorStatus> monitor;
  std::optional<AlignmentStatus> alignment;
  TimeNs truth_began_ns = 0;  ///< the first row of the truth: 0 until there is one
  TimeNs aligned_ns = 0;      ///< stamp of the first status that said aligned: 0 until there is one
  std::map<std::string, ServiceRecord> services;
  std::map<std::string, VerdictTally> verdicts;
  std::map<std::string, Alarm> alarms;  ///< every alarm seen, in its last state
  std::vector<GpsOutage> outages;
  dataset::Score score;
  double distance_m = 0.0;
  std::optional<dataset::NavError> error;  ///< the newest that the truth allows
  /// From the arrival of the inertial sample at its bridge to the navigation state received, host time.
  std::vector<float> latencies_us;

  /// When the vehicle's instruments began to speak: with the truth, or with an earlier navigation state.
  [[nodiscard]] TimeNs vehicle_began_ns() const;
  /// From the vehicle's beginning to aligned; unknown while it is not. What the services take to start before
  /// the first instrument speaks is not the vehicle's.
  [[nodiscard]] double aligned_after_s() const;
  /// The latency that this share of the states does not exceed; unknown without any.
  [[nodiscard]] double latency_us(double share) const;
};

}  // namespace fathom::demo
