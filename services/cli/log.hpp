#pragma once

#include <string>
#include <vector>

#include "config/fusion/fusion_config.hpp"
#include "dataset/dataset.hpp"
#include "samples/nav_state.hpp"

/// What a vehicle recorded: the folder of a data set, or a recording.
namespace fathom::cli {

/// Whether a path names a recording rather than the folder of a data set.
[[nodiscard]] bool is_recording(const std::string& path);

/// Where the configuration of fusion stands. Neither: a recording encloses its own.
struct ConfigFiles {
  std::string vehicle;  ///< the file of the vehicle
  std::string own;      ///< fusion's own file; over that of the vehicle where both are named

  [[nodiscard]] bool none() const { return vehicle.empty() && own.empty(); }
  /// For people: "vehicle.json, over it fusion.json", or "its own configuration".
  [[nodiscard]] std::string text() const;
};

/// The configuration that these files give, with overrides; without any file the one of the fusion service in
/// the recording. Throws Failure and config::ConfigError.
[[nodiscard]] config::LoadedConfig<config::FusionConfig> configuration_for(
    const std::string& log, const ConfigFiles& files, const std::vector<std::string>& sets);

/// The data set in a folder. What a person should know of it is said on standard error, so which files were
/// cut: their rows before that are used. Throws Failure.
[[nodiscard]] dataset::Dataset read_dataset(const std::string& directory, Name vehicle,
                                            TimeNs epoch_ns = dataset::kDefaultEpochNs);

/// Throws Failure where a data set has no file of inertial samples.
void refuse_without_imu_file(const std::string& directory);

/// What the instruments of the configured vehicle said, with at least one inertial sample. In a data set each
/// stream has the name of the first configured sensor of its kind. In a recording sensors keep their names,
/// of inertial units the configured one is read, and the truth is the reference; damaged parts are named on
/// standard error. Throws Failure.
[[nodiscard]] dataset::Dataset read_log(const std::string& log, const config::FusionConfig& config);

/// What instruments and the simulator's truth said in a recording, in its order.
struct RecordedSamples {
  dataset::Dataset data;
  std::vector<NavState> states;
};
/// Of one vehicle; of an empty name: of the one that is heard first. States only where they are asked for.
/// Damaged parts are named on standard error. Throws Failure.
[[nodiscard]] RecordedSamples read_recording(const std::string& file, Name vehicle, bool with_states = false);

/// From when t_s counts: in a recording from the second of its first inertial sample.
[[nodiscard]] TimeNs time_zero_of(const std::string& log, const dataset::Dataset& data);

}  // namespace fathom::cli
