#include "cli/log.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <system_error>

#include "bus/cdr.hpp"
#include "cli/command.hpp"
#include "cli/recording.hpp"
#include "config/vehicle/vehicle_config.hpp"
#include "dataset/remarks.hpp"

namespace fathom::cli {
namespace {

constexpr const char* kTruth = "fathom/v1/truth";
constexpr const char* kNavState = "fathom/v1/nav_state";

template <class T>
void rename(std::vector<T>& stream, SourceKind kind, const config::FusionConfig& config) {
  for (const estimation::SensorConfig& sensor : config.engine.sensors) {
    if (sensor.kind != kind) continue;
    for (T& sample : stream) sample.header.sensor = Name(sensor.sensor);
    return;
  }
}

/// What fusion is given: of inertial units the configured one.
dataset::Dataset read_recording_for(const std::string& file, const config::FusionConfig& config) {
  const Name vehicle(config.common.vehicle);
  const Name unit(config.imu_sensor);
  dataset::Dataset data = read_recording(file, vehicle).data;
  std::erase_if(data.of<ImuSample>(), [&](const ImuSample& one) { return one.header.sensor != unit; });
  if (data.of<ImuSample>().empty()) {
    throw Failure(ExitCode::bad_input, file + ": no inertial samples of unit " + unit.str() + " of vehicle " +
                                           vehicle.str() + ", expected at least one");
  }
  return data;
}

}  // namespace

RecordedSamples read_recording(const std::string& file, Name vehicle, bool with_states) {
  record::Reader reader = open_recording(file);
  RecordedSamples out;
  std::uint64_t foreign = 0;
  const auto take = [&]<class T>(const record::Message& message, std::vector<T>& into) {
    const auto sample = bus::from_cdr<T>(message.data);
    if (!sample) {
      ++foreign;
      return;
    }
    if (vehicle.view().empty()) vehicle = sample->header.vehicle;
    if (sample->header.vehicle == vehicle) into.push_back(*sample);
  };
  record::Selection selection;
  selection.topics.emplace_back(kTruth);
  if (with_states) selection.topics.emplace_back(kNavState);
  for_each_kind([&](auto kind) { selection.topics.emplace_back(kind.kTopic); });
  const auto& counts = reader.contents().statistics.channel_message_counts;
  using Taker = std::function<void(const record::Message&)>;
  std::map<const record::Channel*, Taker> takers;
  const auto taker_of = [&](const record::Channel& channel) {
    Taker taker;
    const auto into = [&](auto& stream) {
      // What the file says of itself may be wrong: no more than that is believed before it is seen.
      constexpr std::uint64_t kMost = 1U << 18U;
      const auto count = counts.find(channel.id);
      if (count != counts.end()) stream.reserve(std::min(count->second, kMost));
      taker = [&](const record::Message& message) { take(message, stream); };
    };
    if (channel.topic == kTruth) into(out.data.reference);
    if (channel.topic == kNavState) into(out.states);
    for_each_kind([&](auto kind) {
      if (channel.topic == kind.kTopic) into(out.data.of<typename decltype(kind)::Sample>());
    });
    return taker;
  };
  const record::Outcome outcome =
      reader.read(selection, [&](const record::Channel& channel, const record::Message& message) {
        auto known = takers.find(&channel);
        if (known == takers.end()) known = takers.emplace(&channel, taker_of(channel)).first;
        known->second(message);
        return true;
      });
  for (const std::string& problem : outcome.problems)
    std::fprintf(stderr, "fathom: %s: %s\n", file.c_str(), problem.c_str());
  if (foreign > 0) {
    std::fprintf(stderr, "fathom: %s: %llu samples are none of their topics' types\n", file.c_str(),
                 static_cast<unsigned long long>(foreign));
  }
  return out;
}

bool is_recording(const std::string& path) {
  return path.ends_with(".mcap");
}

std::string ConfigFiles::text() const {
  if (none()) return "its own configuration";
  return vehicle.empty() || own.empty() ? vehicle + own : vehicle + ", over it " + own;
}

config::LoadedConfig<config::FusionConfig> configuration_for(const std::string& log, const ConfigFiles& files,
                                                             const std::vector<std::string>& sets) {
  std::error_code error;
  const auto status = std::filesystem::status(log, error);
  if (!is_recording(log) && !std::filesystem::is_directory(status)) {
    const std::string what = std::filesystem::exists(status) ? "is no folder"
                             : error && status.type() == std::filesystem::file_type::none
                                 ? error.message()
                                 : "No such file or directory";
    throw Failure(ExitCode::bad_input,
                  log + ": " + what + ", expected the folder of a data set or a recording, FILE.mcap");
  }
  if (files.none() && !is_recording(log))
    throw Failure(
        ExitCode::bad_configuration,
        "--vehicle or --config is required: a data set has no configuration of its own; see --help");
  config::LoadRequest request{files.own, sets};
  if (!files.vehicle.empty()) request = config::with_vehicle(std::move(request), files.vehicle, "fusion");
  if (!files.none()) return config::load_service_config<config::FusionConfig>(request);
  record::Reader reader = open_recording(log);
  return recorded_configuration(reader, log, "fusion", sets);
}

dataset::Dataset read_dataset(const std::string& directory, Name vehicle, TimeNs epoch_ns) {
  try {
    const dataset::ReadOptions options{epoch_ns, vehicle, true};
    dataset::Dataset data = dataset::read(directory, options);
    for (const std::string& remark : dataset::remarks(directory, data, options))
      std::fprintf(stderr, "fathom: %s: %s\n", directory.c_str(), remark.c_str());
    return data;
  } catch (const dataset::DatasetError& error) {
    throw Failure(ExitCode::bad_input, error.what());
  }
}

void refuse_without_imu_file(const std::string& directory) {
  const std::filesystem::path plain = std::filesystem::path(directory) / "imu.csv";
  std::error_code error;
  if (!std::filesystem::exists(plain, error) && !std::filesystem::exists(plain.string() + ".gz", error))
    throw Failure(ExitCode::bad_input,
                  plain.string() + ": is not there, nor is imu.csv.gz; expected the inertial samples");
}

dataset::Dataset read_log(const std::string& log, const config::FusionConfig& config) {
  if (is_recording(log)) return read_recording_for(log, config);
  dataset::Dataset data = read_dataset(log, Name(config.common.vehicle));
  refuse_without_imu_file(log);
  if (data.of<ImuSample>().empty())
    throw Failure(ExitCode::bad_input, log + "/imu.csv: no inertial samples, expected at least one row");
  for_each_aiding_kind(
      [&](auto kind) { rename(data.of<typename decltype(kind)::Sample>(), kind.kSource, config); });
  return data;
}

TimeNs time_zero_of(const std::string& log, const dataset::Dataset& data) {
  if (!is_recording(log)) return dataset::kDefaultEpochNs;
  return data.of<ImuSample>().front().header.stamp_ns / kNsPerSecond * kNsPerSecond;
}

}  // namespace fathom::cli
