#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/unknown.hpp"
#include "samples/header.hpp"
#include "samples/nav_state.hpp"

namespace fathom {

enum class Severity : std::uint8_t { notice = 0, warning = 1, critical = 2 };
[[nodiscard]] std::string_view to_string(Severity severity);

/// A latched condition. header.sensor is unused; `alarm` is the key.
struct Alarm {
  SampleHeader header;
  Name alarm;  ///< e.g. "gps_outage", "service_missing:fusion"
  Severity severity = Severity::notice;
  bool active = false;        ///< the condition holds now
  bool acknowledged = false;  ///< an operator has seen it
  TimeNs since_ns = 0;
  TimeNs cleared_ns = 0;  ///< 0 while active
  std::string text;       ///< one English sentence
  double value = kUnknown;
  double limit = kUnknown;
};

enum class Presence : std::uint8_t { never_seen = 0, present = 1, stale = 2, missing = 3 };
[[nodiscard]] std::string_view to_string(Presence presence);

/// One sensor stream or service as the monitor sees it.
struct WatchedItem {
  Name name;
  Presence presence = Presence::never_seen;
  double age_s = kUnknown;    ///< since last heard
  double rate_hz = kUnknown;  ///< over the last seconds
};

/// What one satellite receiver gave, by the monitor's own clock.
struct ReceiverOutage {
  Name name;
  bool active = false;
  Severity severity = Severity::notice;  ///< of the present outage
  TimeNs since_ns = 0;         ///< UTC of the last usable fix before the present outage, 0 when there is none
  double outage_s = kUnknown;  ///< length of the present outage, 0 when none, NaN before the first fix
  double longest_s = 0.0;
  double total_s = 0.0;
  std::uint32_t count = 0;
};

struct MonitorStatus {
  SampleHeader header;
  bool known = false;    ///< false: the monitor has just been started and cannot say yet how the vehicle is
  bool healthy = false;  ///< never while it is not known
  NavMode mode = NavMode::none;
  AlignmentPhase alignment = AlignmentPhase::none;
  double nav_state_age_s = kUnknown;
  bool gps_outage_active = false;
  Severity gps_outage_severity = Severity::notice;  ///< of the present outage
  TimeNs gps_outage_since_ns = 0;  ///< UTC of the last usable fix before the present outage, 0: none
  double gps_outage_s = kUnknown;  ///< length of the present outage, 0 when none, NaN before the first fix
  double gps_outage_longest_s = 0.0;
  double gps_outage_total_s = 0.0;
  std::uint32_t gps_outage_count = 0;
  std::uint32_t alarms_active = 0;
  std::uint32_t alarms_unacknowledged = 0;
  std::vector<WatchedItem> sensors;       ///< at most 32
  std::vector<WatchedItem> services;      ///< at most 32
  std::vector<ReceiverOutage> receivers;  ///< at most 16
};

enum class ServiceState : std::uint8_t { starting = 0, healthy = 1, degraded = 2, stopping = 3 };
[[nodiscard]] std::string_view to_string(ServiceState state);

/// How many counters one life sign carries at most (ServiceStatus in idl/health.idl).
inline constexpr std::size_t kMostCounters = 64;

/// A counter that a service publishes, e.g. {"frames_good", 1234}.
struct ServiceCounter {
  Name name;
  std::uint64_t value = 0;
};

/// A rate that a service publishes, e.g. {"samples", 100.0}.
struct ServiceRate {
  Name name;
  double hz = kUnknown;
};

/// Life sign of a service, once a second. header.sensor is the service's name and the key.
struct ServiceStatus {
  SampleHeader header;
  ServiceState state = ServiceState::starting;
  std::string version;
  std::string config_hash;  ///< hex of the effective configuration
  std::string host;
  std::uint32_t pid = 0;
  TimeNs started_ns = 0;
  DurationNs utc_offset_ns = 0;    ///< UTC of its host minus the time in its stamps: the host's clock was set
  std::string text;                ///< why it is not healthy
  std::vector<ServiceRate> rates;  ///< at most 16
  std::vector<ServiceCounter> counters;  ///< at most kMostCounters

  /// 0 when there is none of that name: services leave out what never happened.
  [[nodiscard]] std::uint64_t counter(std::string_view name) const;
};

}  // namespace fathom
