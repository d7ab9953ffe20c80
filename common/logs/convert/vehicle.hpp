#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "dataset/dataset.hpp"
#include "logs/series.hpp"

/// What a log becomes: a data set, and beside it what the layout of data sets has no place for.
namespace fathom::logs {

inline constexpr double kTeslaPerGauss = 1e-4;

/// A figure that is none where it is not positive.
inline double positive(double value) {
  return value > 0.0 ? value : kUnknown;
}

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
  std::optional<TimeNs> utc_of_start_ns;  ///< of the log's zero
};

/// What a bag of ROS 2 does not tell of itself.
struct Ros2Options {
  enum class Axes : std::uint8_t { flu, frd };  ///< with them the world: ENU, NED
  std::map<std::string, Axes> axes;             ///< of topics
  std::map<std::string, std::array<double, 3>>
      mounting_rpy_rad;            ///< of frames: FRD of the sensor in the body
  std::string base = "base_link";  ///< the frame of the vehicle's body
  double surface_pressure_Pa = 101325.0;
  double water_density_kg_m3 = 1025.0;
};

struct ConvertOptions {
  std::map<std::string, std::string> choice;  ///< file ("imu") to series ("vehicle_imu:1")
  bool utc =
      false;  ///< t_s counts from dataset::kDefaultEpochNs in UTC instead of from the autopilot's start
  Ros2Options ros2 = {};
};

/// The topics that px4() and ardupilot() look at.
[[nodiscard]] const std::set<std::string>& px4_topics();
[[nodiscard]] const std::set<std::string>& ardupilot_topics();

/// Frames: both autopilots give forward-right-down and north-east-down as the data set wants them. Throw
/// LogError where a choice names no series of the log, or where UTC is asked for and GPS has not told it.
[[nodiscard]] Vehicle px4(const Log& log, const ConvertOptions& options = {});
[[nodiscard]] Vehicle ardupilot(const Log& log, const ConvertOptions& options = {});
/// Turns forward-left-up and east-north-up to ours, and sensors that are mounted otherwise to the body's
/// axes. Throws LogError likewise, and where an option names no topic or frame of the log.
[[nodiscard]] Vehicle ros2_bag(const Log& log, const ConvertOptions& options = {});

}  // namespace fathom::logs
