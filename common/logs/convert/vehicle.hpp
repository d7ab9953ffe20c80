#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "dataset/dataset.hpp"
#include "logs/series.hpp"

/// What a log becomes: a data set, and beside it what the layout of data sets has no place for.
namespace fathom::logs {

/// A file beside those of the data set, with t_s first.
struct Table {
  std::string name;                  ///< "mag"
  std::vector<std::string> columns;  ///< behind t_s
  std::vector<TimeNs> stamps_ns;
  std::vector<double> values;  ///< row by row
};

struct Vehicle {
  dataset::Dataset data;
  std::vector<Table> tables;
  /// What each file was made from, "sensor_combined:0".
  std::map<std::string, std::string> sources;
  /// What else could have been: for the option that chooses.
  std::map<std::string, std::vector<std::string>> others;
  std::vector<std::string> notes;
  std::optional<TimeNs> utc_of_start_ns;  ///< of the autopilot's zero, by GPS
};

struct ConvertOptions {
  std::map<std::string, std::string> choice;  ///< file ("imu") to series ("vehicle_imu:1")
  bool utc =
      false;  ///< t_s counts from dataset::kDefaultEpochNs in UTC instead of from the autopilot's start
};

/// The topics that px4() and ardupilot() look at.
[[nodiscard]] const std::set<std::string>& px4_topics();
[[nodiscard]] const std::set<std::string>& ardupilot_topics();

/// Frames: both autopilots give forward-right-down and north-east-down as the data set wants them. Throw
/// LogError where a choice names no series of the log, or where UTC is asked for and GPS has not told it.
[[nodiscard]] Vehicle px4(const Log& log, const ConvertOptions& options = {});
[[nodiscard]] Vehicle ardupilot(const Log& log, const ConvertOptions& options = {});

}  // namespace fathom::logs
