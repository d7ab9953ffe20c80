#pragma once

#include <map>
#include <string>
#include <vector>

#include "demo/observation.hpp"
#include "sim/scenario.hpp"

namespace fathom::demo {

/// One demand on the run and what became of it.
struct Finding {
  bool met = false;
  std::string text;  ///< e.g. "horizontal error 1.2 m rms, limit 5 m"
};

/// What a run is held against.
struct Demands {
  sim::ScenarioLimits limits;
  bool whole_run = true;              ///< the run lasted as long as the scenario is meant to
  double end_error_share = kUnknown;  ///< of the distance travelled; for recorded vehicles
  bool gps_expected = true;
  bool alignment_expected = true;
  double gps_limit_s = 5.0;
  double nav_rate_hz = 100.0;  ///< of the inertial sensor
  double startup_s = 15.0;     ///< what services get to start, of the monitor
  double silence_s = 3.0;      ///< a service without a life sign for longer is missing, of the monitor
  std::vector<std::string> expected_alarms;  ///< names; one that ends in '*' stands for all that begin so
  std::vector<std::string> services;         ///< that must have been healthy
  std::map<std::string, int> restarts;
  std::vector<std::string> killed;  ///< did not stop when asked
};

/// How often navigation states came, over the run: also what was missing at its beginning and end counts.
[[nodiscard]] double rate_hz(const Observation& seen, const Demands& demands);
/// The share of the states due that were valid, from the first valid one or from when it was due at the
/// latest, and not before limits.score_from_s. Unknown when none was due.
[[nodiscard]] double valid_share(const Observation& seen, const Demands& demands);

/// Every demand in the order of a report. Pure.
[[nodiscard]] std::vector<Finding> judge(const Observation& seen, const Demands& demands);

}  // namespace fathom::demo
