#pragma once

#include <string>

#include "config/common_config.hpp"
#include "config/registry.hpp"
#include "health/vehicle_health.hpp"

namespace fathom::config {

/// Section "journal": the record of alarms that outlives the monitor.
struct JournalConfig {
  std::string path;  ///< empty: none
};

/// Section "metrics": what a Prometheus server asks for.
struct MetricsConfig {
  bool enabled = true;
  std::string address = "127.0.0.1";  ///< listened at; an IPv4 address of this host, or 0.0.0.0 for all
  int port = 9464;
};

/// deploy/config/monitor.json
struct MonitorConfig {
  CommonConfig common;
  health::HealthConfig health;  ///< its `vehicle` is that of `common`; the rest stands at the top of the file
  JournalConfig journal;
  MetricsConfig metrics;
  double evaluation_hz = 20.0;  ///< how often everything is judged
  double status_hz = 4.0;       ///< of MonitorStatus; a change is published at once besides
  double alarm_repeat_s = 5.0;  ///< alarms are published again this often, with their present text and value
};

[[nodiscard]] ConfigKind monitor_kind();

}  // namespace fathom::config
