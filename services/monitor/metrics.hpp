#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <prometheus/metric_family.h>

#include "samples/forecast.hpp"
#include "samples/status/health.hpp"
#include "samples/verdict.hpp"

namespace fathom::monitor {

/// The values that metrics are made of, at one moment.
struct MetricsSnapshot {
  MonitorStatus status;
  std::vector<Alarm> alarms;
  std::vector<ForecastLimit> forecast;  ///< empty when none is fresh
  double horizontal_95_m = kUnknown;
  std::map<Name, std::array<std::uint64_t, kVerdictKinds>> verdicts;  ///< by sensor
  std::array<std::uint64_t, 3> raised{};                              ///< alarms, by severity
  std::uint64_t acknowledged = 0;
  std::uint64_t dropped = 0;
  std::uint64_t journal_lines = 0;
  std::uint64_t journal_failures = 0;
};

/// The metrics in the form of Prometheus: base units, counters end in _total. An unknown quantity has no
/// series. Every series has the label `vehicle`.
[[nodiscard]] std::vector<prometheus::MetricFamily> metric_families(const MetricsSnapshot& snapshot);

/// Answers GET /metrics. `take` is called for each scrape, on a thread of the server.
class MetricsServer {
 public:
  explicit MetricsServer(std::function<MetricsSnapshot()> take);
  ~MetricsServer();
  MetricsServer(const MetricsServer&) = delete;
  MetricsServer& operator=(const MetricsServer&) = delete;

  /// Starts to answer. Returns nothing, or why it failed in one line; the caller may try again later.
  [[nodiscard]] std::string start(const std::string& address, int port);
  [[nodiscard]] bool running() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::monitor
