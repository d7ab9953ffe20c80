#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "logs/ros2/schema.hpp"
#include "logs/series.hpp"
#include "record/file.hpp"

/// Bags of ROS 2 in MCAP (rosbag2's format since Iron): messages in CDR, schemas "ros2msg".
namespace fathom::logs::ros2 {

inline constexpr const char* kFormatName = "ROS 2 MCAP";

/// True where the file begins as MCAP does; of a folder, where such files may be in it.
[[nodiscard]] bool looks_like(const std::filesystem::path& path);

/// Whether messages of this layout are kept: inertial units, fixes, pressures, magnetic fields, twists,
/// odometry and, whoever defined it, a DVL's velocity.
[[nodiscard]] bool is_wanted(const Schema& schema);
/// A message of a DVL by its name and its velocity.
[[nodiscard]] bool is_dvl(const Schema& schema);

struct ReadLimits {
  std::size_t values = std::size_t{1} << 28U;  ///< numbers kept of all messages: 2 GiB
};

/// Reads a whole file, or the files of a folder as one bag. A series is a topic, and where the messages of
/// one topic are of several types or frames one for each. Its time is the log time, counted from the first
/// one. What cannot be used stands in `losses`. Throws LogError where nothing can be read, or where it would
/// take more memory than the limits.
[[nodiscard]] Log read(const std::filesystem::path& path, const ReadLimits& limits = {});
/// Likewise; `name` is what errors call it.
[[nodiscard]] Log read(std::unique_ptr<record::Source> source, const std::string& name,
                       const ReadLimits& limits = {});

}  // namespace fathom::logs::ros2
