#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "samples/alignment_status.hpp"
#include "samples/forecast.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/verdict.hpp"

namespace fathom::status {

/// A sample with the time since it arrived.
template <class T>
struct Heard {
  T sample;
  double age_s = 0.0;
};

/// The verdicts on one sensor since this view began.
struct VerdictCounts {
  std::uint64_t used = 0;
  std::uint64_t not_used = 0;
  VerdictKind last_refusal = VerdictKind::used;  ///< used: there was none
  VerdictKind last = VerdictKind::used;
  double last_age_s = kUnknown;
  double refused_for_s = 0.0;  ///< since the first of the refusals in a row up to now; 0: the last is none
};

/// The newest samples of one vehicle, at one moment.
struct StatusView {
  TimeNs utc_ns = 0;
  int domain = 0;
  double window_s = 0.0;  ///< how long this view has been listening
  std::string vehicle;
  std::optional<Heard<NavState>> nav;
  double nav_rate_hz = kUnknown;
  std::optional<Heard<AlignmentStatus>> alignment;
  std::optional<Heard<MonitorStatus>> monitor;
  std::optional<Heard<Forecast>> forecast;
  std::map<Name, Heard<ServiceStatus>> services;
  std::map<Name, Alarm> alarms;
  std::map<Name, VerdictCounts> verdicts;
};

/// The order of alarms: active first, then the more severe, then the older.
[[nodiscard]] std::vector<Alarm> sorted_alarms(const StatusView& view);

}  // namespace fathom::status
