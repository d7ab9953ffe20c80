#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// What a flight log of somebody else's autopilot holds, before anything is made of it.
namespace fathom::logs {

/// The file cannot be used. what() is "FILE: offset N: what is wrong, what was expected".
class LogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// All messages of one name and instance, in the order of the file: a table of numbers. Names and units are
/// those of the log (DataFlash values are multiplied out to the unit that the log names). A time is in
/// microseconds since the autopilot started.
struct Series {
  std::string topic;
  unsigned instance = 0;
  std::vector<std::string> columns;
  std::vector<double> values;      ///< row by row
  std::vector<std::int64_t> t_us;  ///< one a row
  std::string type;                ///< of the messages, where the log names it: "sensor_msgs/Imu"
  std::string frame;               ///< likewise, that their coordinates are in: "imu_link"
  std::string child_frame;         ///< likewise, whose motion they tell: "base_link"

  [[nodiscard]] std::size_t rows() const { return t_us.size(); }
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
  /// The first of several names that exists.
  [[nodiscard]] std::optional<std::size_t> find_any(std::initializer_list<std::string_view> names) const;
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return values[row * columns.size() + column];
  }
  /// Unknown where there is no such column.
  [[nodiscard]] double at(std::size_t row, const std::optional<std::size_t>& column) const;
  /// The columns of these names; nothing when one is missing.
  [[nodiscard]] std::optional<std::array<std::size_t, 3>> find_three(
      const std::array<std::string, 3>& names) const;
  /// Takes the columns `name[0]`, `name[1]`, `name[2]`; nothing when one is missing.
  [[nodiscard]] std::optional<std::array<std::size_t, 3>> find_vector(const std::string& name) const;
  [[nodiscard]] std::string label() const { return topic + ":" + std::to_string(instance); }
};

/// A stretch of the file that gave nothing.
struct Lost {
  std::optional<std::uint64_t> offset;  ///< where the file is not packed
  std::uint64_t bytes = 0;
  std::string what;
};

/// Everything that gave nothing; the first kMostListed in detail.
struct Losses {
  static constexpr std::size_t kMostListed = 50;
  std::vector<Lost> listed;
  std::uint64_t count = 0;
  std::uint64_t bytes = 0;
  void add(std::optional<std::uint64_t> offset, std::uint64_t length, std::string what);
};

/// Where one frame of coordinates is in another, as the log says: x_parent = R(q) x_child + translation.
struct Placement {
  std::string parent;
  std::string child;
  std::array<double, 3> translation_m{};
  std::array<double, 4> q_wxyz{1.0, 0.0, 0.0, 0.0};
};

/// A line that the autopilot said.
struct LoggedText {
  std::int64_t t_us = 0;
  int level = 6;  ///< as in syslog: 0 emergency ... 7 debug
  std::string text;
};

struct Log {
  std::string format;                                     ///< "PX4 ULog", "ArduPilot DataFlash", "ROS 2 MCAP"
  std::map<std::string, std::string> info;                ///< what the log says of itself
  std::map<std::string, std::vector<std::string>> lists;  ///< likewise, several values a key
  std::map<std::string, double> parameters;               ///< of the autopilot, as they were last
  std::vector<LoggedText> texts;
  std::map<std::string, std::uint64_t> messages;  ///< every topic of the log and its messages
  std::vector<Series> series;                     ///< the wanted topics
  std::vector<Placement> placements;              ///< of frames, which do not change
  std::int64_t start_ns = 0;   ///< what 0 of `t_us` is by the log's own clock, where it says
  std::uint64_t dropouts = 0;  ///< times that the logger itself was too slow
  std::uint64_t dropout_ms = 0;
  Losses losses;
  std::vector<std::string> notes;  ///< what a person should know

  /// The series of a topic, by instance.
  [[nodiscard]] std::vector<const Series*> of(std::string_view topic) const;
};

/// Drops rows whose time lies more than an hour off both neighbours while these agree with each other: times
/// that damage has made. Returns how many.
std::size_t drop_stray_times(Series& series);

}  // namespace fathom::logs
