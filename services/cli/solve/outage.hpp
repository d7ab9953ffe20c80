#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/unknown.hpp"
#include "cli/solve/fixes.hpp"
#include "cli/solve/run.hpp"

namespace fathom::cli {

/// --gps-outage T1,T2,...[@start[:recover]] or random:N[@start]
struct OutageRequest {
  std::vector<double> durations_s;
  int random = 0;                 ///< so many of 5 to 60 s at random, instead of the durations
  std::optional<double> start_s;  ///< seconds of the data set; none: 60 s after motion begins
  double recover_s = 40.0;        ///< of GPS behind each window
};

/// Throws Failure (exit 2) when the text is no such request.
[[nodiscard]] OutageRequest parse_outages(const std::string& text);

/// When the GPS of a data set moves: above a quarter of its 95th percentile of speed, at least 0.5 m/s.
struct Motion {
  TimeNs first_ns = 0;
  TimeNs last_ns = 0;
};
[[nodiscard]] std::optional<Motion> motion_of(const std::vector<GpsSample>& gps);

/// Windows of `duration_ns` from `begin_ns`, each followed by `recover_ns`, as long as a whole one ends at or
/// before `last_ns`.
[[nodiscard]] std::vector<GpsWindow> windows(TimeNs begin_ns, TimeNs last_ns, DurationNs duration_ns,
                                             DurationNs recover_ns);

/// One window as the filter lived through it.
struct OutageWindow {
  double start_s = kUnknown;             ///< seconds of the data set
  double end_s = kUnknown;               ///< instant of the last removed fix, where the error is taken
  double horizontal_error_m = kUnknown;  ///< of the antenna against the removed fix
  FixErrors inside;                      ///< of the filter at every removed fix
  FixErrors smoothed_inside;             ///< likewise with the fixes behind the window too; where asked for
  double predicted_95_m = kUnknown;      ///< the filter's own 95 % at that instant
  double forecast_95_m = kUnknown;       ///< what its forecast said when the window began
  double fix_95_m = 0.0;                 ///< what the fix itself may be off
  std::map<std::string, double> time_to_limit_s;  ///< of that forecast
};

/// All windows of one duration, pooled over the four starts.
struct OutageFigures {
  double duration_s = 0.0;  ///< 0: random
  std::vector<OutageWindow> windows;
  double forecast_coverage = kUnknown;   ///< share of the errors inside what was forecast at the beginning
  double predicted_coverage = kUnknown;  ///< likewise the filter's own figure at the end
  double rms_m = kUnknown;
  double p95_m = kUnknown;
  double max_m = kUnknown;
  double inside_rms_m = kUnknown;  ///< over every removed fix, not only the last of each window
  double smoothed_inside_rms_m = kUnknown;
};

/// Runs the data set with the windows removed, once for start, start + 13, + 26 and + 39 s of each duration.
/// With `smooth` each also through the smoother. Throws Failure (exit 3) when no window fits.
/// `solve_run.on_state` and `solve_run.gps_removed` are not used.
[[nodiscard]] std::vector<OutageFigures> run_outages(const SolveRun& solve_run, const OutageRequest& request,
                                                     bool smooth, TimeNs epoch_ns,
                                                     const std::string& directory);

/// The windows of the first duration and start: those that nav.csv shows.
[[nodiscard]] std::vector<GpsWindow> first_windows(const dataset::Dataset& data, const OutageRequest& request,
                                                   TimeNs epoch_ns, const std::string& directory);

}  // namespace fathom::cli
