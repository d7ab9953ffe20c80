#include "logs/ros2/reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "logs/ros2/cdr.hpp"
#include "record/reader.hpp"

namespace fathom::logs::ros2 {
namespace {

constexpr std::size_t kMostSeries = 256;
constexpr std::size_t kMostPlacements = 1024;
constexpr std::size_t kPlacementsKept = 256;  // of one message
constexpr const char* kTransforms = "tf2_msgs/TFMessage";

bool has(const std::vector<std::string>& all, std::string_view name) {
  return std::find(all.begin(), all.end(), name) != all.end();
}
std::optional<std::size_t> place_of(const std::vector<std::string>& all, std::string_view name) {
  const auto found = std::find(all.begin(), all.end(), name);
  if (found == all.end()) return std::nullopt;
  return static_cast<std::size_t>(found - all.begin());
}
std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// The files of a bag's folder, as rosbag2 numbers them: NAME_2.mcap before NAME_10.mcap.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> out;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".mcap") out.push_back(entry.path());
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
    const std::string& x = a.native();
    const std::string& y = b.native();
    return std::pair(x.size(), x) < std::pair(y.size(), y);
  });
  return out;
}

/// A channel of the file, and how its messages are read.
struct Source {
  Schema schema;
  bool transforms = false;
  std::optional<std::size_t> frame;        ///< place among the texts
  std::optional<std::size_t> child_frame;  ///< likewise
  std::size_t definition = 0;              ///< which of the definitions; the same in all files of a bag
};

class Reading {
 public:
  Reading(std::string name, const ReadLimits& limits) : name_(std::move(name)), limits_(limits) {
    log_.format = kFormatName;
  }

  /// The next file of the bag. `part`: what its losses begin with.
  void add(record::Reader reader, const std::string& part) {
    const record::Contents& contents = reader.contents();
    log_.info["profile"] = contents.header.profile;
    log_.info["library"] = contents.header.library;
    part_ = part;
    if (!contents.ending.empty()) log_.notes.push_back(part_ + contents.ending);
    sources_.clear();
    record::Selection wanted;
    for (const auto& [id, channel] : contents.channels) {
      count(channel, contents);
      if (prepare(reader, channel) && !has(wanted.topics, channel.topic))
        wanted.topics.push_back(channel.topic);
    }
    for (const auto& [id, schema] : contents.schemas)
      is_own_ |= schema.encoding == "omgidl" && schema.name.starts_with("fathom::");
    if (wanted.topics.empty()) return;
    const record::Outcome outcome =
        reader.read(wanted, [this](const record::Channel& channel, const record::Message& message) {
          take(channel, message);
          return true;
        });
    for (const std::string& problem : outcome.problems) log_.losses.add(std::nullopt, 0, part_ + problem);
  }

  Log finish() {
    if (log_.series.empty()) {
      throw LogError(
          name_ + ": " +
          (log_.losses.count == 0 ? nothing() : "nothing could be used: " + log_.losses.listed[0].what));
    }
    settle_times();
    return std::move(log_);
  }

 private:
  [[nodiscard]] std::string nothing() const {
    if (is_own_) return "a recording of fathom, not of ROS 2: fathom solve reads it as it is";
    return "no message that a data set can be made of, expected sensor_msgs/msg/Imu or the like; it has " +
           std::to_string(log_.messages.size()) + " topics";
  }

  void count(const record::Channel& channel, const record::Contents& contents) {
    const auto found = contents.statistics.channel_message_counts.find(channel.id);
    log_.messages[channel.topic] +=
        found == contents.statistics.channel_message_counts.end() ? 0 : found->second;
  }

  /// Whether the channel's messages are wanted; notes why not where their kind is.
  bool prepare(const record::Reader& reader, const record::Channel& channel) {
    const record::Schema* described = reader.schema_of(channel);
    // Types of ROS have a package: those of others' recordings are not meant.
    if (described == nullptr || channel.message_encoding != "cdr" ||
        !described->encoding.starts_with("ros2") || described->name.find('/') == std::string::npos)
      return false;
    const std::string type = short_type(described->name);
    const bool transforms = type == kTransforms && channel.topic.ends_with("tf_static");
    Schema by_name;
    by_name.type = type;
    const bool named = transforms || is_wanted(by_name) || lower(type).find("dvl") != std::string::npos;
    if (!named) return false;
    const std::string where = part_ + channel.topic + ": schema " + described->name + ": ";
    if (described->encoding != "ros2msg") {
      log_.losses.add(std::nullopt, 0,
                      where + "encoding '" + described->encoding.substr(0, 32) + "', expected ros2msg");
      return false;
    }
    auto parsed = parse(type, described->data, transforms ? kPlacementsKept : 8);
    if (!parsed) {
      log_.losses.add(std::nullopt, 0, where + parsed.error().message);
      return false;
    }
    if (!transforms && !is_wanted(parsed.value())) return false;
    Source source;
    source.schema = std::move(parsed.value());
    source.transforms = transforms;
    source.frame = place_of(source.schema.texts, "header.frame_id");
    source.child_frame = place_of(source.schema.texts, "child_frame_id");
    source.definition =
        definitions_.emplace(type + "\n" + described->data, definitions_.size()).first->second;
    sources_[channel.id] = std::move(source);
    return true;
  }

  void take(const record::Channel& channel, const record::Message& message) {
    const auto found = sources_.find(channel.id);
    if (found == sources_.end()) return;  // another type under the same topic
    Source& source = found->second;
    std::string why;
    if (!sound_stamp(message.log_time)) {
      why = "its log time is no time";
    } else {
      why = decode(source.schema, message.data, row_);
      if (why.empty()) why = source.transforms ? place(source) : keep(channel, source, message.log_time);
    }
    if (!why.empty()) {
      log_.losses.add(std::nullopt, message.data.size(),
                      part_ + channel.topic + ": " + source.schema.type + " at log time " +
                          seconds(message.log_time) + ": " + why);
    }
  }
  static std::string seconds(TimeNs time) {
    const std::string part = std::to_string(time % kNsPerSecond);
    return std::to_string(time / kNsPerSecond) + "." +
           std::string(9 - std::min<std::size_t>(9, part.size()), '0') + part;
  }

  std::string keep(const record::Channel& channel, Source& source, TimeNs log_time) {
    std::tuple<std::string, std::size_t, std::string, std::string> key{
        channel.topic, source.definition, {}, {}};
    if (source.frame) std::get<2>(key) = row_.texts[*source.frame];
    if (source.child_frame) std::get<3>(key) = row_.texts[*source.child_frame];
    auto known = series_.find(key);
    if (known == series_.end()) {
      if (log_.series.size() == kMostSeries)
        return "frame '" + std::get<2>(key).substr(0, 60) + "': more than " + std::to_string(kMostSeries) +
               " topics and frames";
      Series made;
      made.topic = channel.topic;
      made.instance = instances_[channel.topic]++;
      made.columns = source.schema.columns;
      made.type = source.schema.type;
      made.frame = std::get<2>(key);
      made.child_frame = std::get<3>(key);
      known = series_.emplace(std::move(key), log_.series.size()).first;
      log_.series.push_back(std::move(made));
    }
    values_ += row_.values.size();
    if (values_ > limits_.values) {
      throw LogError(name_ + ": " + channel.topic + ": more than " + std::to_string(limits_.values) +
                     " numbers in the messages, expected a shorter bag: split it by time or topics");
    }
    Series& series = log_.series[known->second];
    series.values.insert(series.values.end(), row_.values.begin(), row_.values.end());
    series.t_us.push_back(log_time / 1000);
    return {};
  }

  std::string place(const Source& source) {
    const Schema& schema = source.schema;
    const auto value = [&](const std::string& name) {
      const auto at = place_of(schema.columns, name);
      return at ? row_.values[*at] : kUnknown;
    };
    const double all = value("transforms.length");
    for (std::size_t i = 0; i < kPlacementsKept && static_cast<double>(i) < all; ++i) {
      const std::string one = "transforms[" + std::to_string(i) + "].";
      const auto parent = place_of(schema.texts, one + "header.frame_id");
      const auto child = place_of(schema.texts, one + "child_frame_id");
      if (!parent || !child) return one + "child_frame_id is not in its definition";
      Placement found{std::string(row_.texts[*parent]),
                      std::string(row_.texts[*child]),
                      {value(one + "transform.translation.x"), value(one + "transform.translation.y"),
                       value(one + "transform.translation.z")},
                      {value(one + "transform.rotation.w"), value(one + "transform.rotation.x"),
                       value(one + "transform.rotation.y"), value(one + "transform.rotation.z")}};
      double norm2 = 0.0;
      for (const double part : found.q_wxyz) norm2 += part * part;
      double sum = 0.0;
      for (const double part : found.translation_m) sum += part;
      if (!(norm2 > 0.98 && norm2 < 1.02) || !(std::abs(sum) < 1e6))
        return one + "transform: child " + found.child.substr(0, 60) + ": no rotation and translation";
      if (log_.placements.size() == kMostPlacements)
        return "more than " + std::to_string(kMostPlacements) + " transforms";
      log_.placements.push_back(std::move(found));
    }
    if (all > static_cast<double>(kPlacementsKept))
      return "transforms: the first " + std::to_string(kPlacementsKept) + " are taken";
    return {};
  }

  void settle_times() {
    std::int64_t first = std::numeric_limits<std::int64_t>::max();
    for (Series& series : log_.series) {
      if (const std::size_t count = drop_stray_times(series); count > 0) {
        log_.losses.add(std::nullopt, 0,
                        series.topic + ": " + std::to_string(count) + " messages whose log time cannot be");
      }
      for (const std::int64_t t_us : series.t_us) first = std::min(first, t_us);
    }
    if (first == std::numeric_limits<std::int64_t>::max()) return;
    for (Series& series : log_.series)
      for (std::int64_t& t_us : series.t_us) t_us -= first;
    log_.start_ns = first * 1000;
  }

  std::string name_;
  std::string part_;
  ReadLimits limits_;
  Log log_;
  Row row_;
  std::size_t values_ = 0;
  bool is_own_ = false;
  std::map<std::uint16_t, Source> sources_;         // of the file that is read
  std::map<std::string, std::size_t> definitions_;  // of all
  std::map<std::tuple<std::string, std::size_t, std::string, std::string>, std::size_t> series_;
  std::map<std::string, unsigned> instances_;
};

}  // namespace

bool is_dvl(const Schema& schema) {
  return lower(schema.type).find("dvl") != std::string::npos && has(schema.columns, "velocity.x") &&
         has(schema.columns, "velocity.y") && has(schema.columns, "velocity.z");
}

bool is_wanted(const Schema& schema) {
  static const std::set<std::string> kTypes{
      "sensor_msgs/Imu",           "sensor_msgs/NavSatFix",      "sensor_msgs/FluidPressure",
      "sensor_msgs/MagneticField", "geometry_msgs/TwistStamped", "geometry_msgs/TwistWithCovarianceStamped",
      "nav_msgs/Odometry"};
  return kTypes.contains(schema.type) || is_dvl(schema);
}

bool looks_like(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return !files_of(path).empty();
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::ifstream file(path, std::ios::binary);
  std::array<char, record::kMagic.size()> begin{};
  file.read(begin.data(), begin.size());
  return file && std::equal(begin.begin(), begin.end(), record::kMagic.begin(),
                            [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

Log read(std::unique_ptr<record::Source> source, const std::string& name, const ReadLimits& limits) {
  auto reader = record::Reader::open(std::move(source));
  if (!reader) throw LogError(name + ": " + reader.error().message);
  Reading reading(name, limits);
  reading.add(std::move(reader.value()), "");
  return reading.finish();
}

Log read(const std::filesystem::path& path, const ReadLimits& limits) {
  std::error_code error;
  const bool folder = std::filesystem::is_directory(path, error);
  Reading reading(path.string(), limits);
  for (const std::filesystem::path& file : folder ? files_of(path) : std::vector{path}) {
    auto reader = record::Reader::open(file);
    if (!reader) throw LogError(reader.error().message);
    reading.add(std::move(reader.value()), folder ? file.filename().string() + ": " : "");
  }
  return reading.finish();
}

}  // namespace fathom::logs::ros2
