#pragma once

#include <string>

#include "config/fusion/fusion_config.hpp"
#include "dataset/dataset.hpp"

namespace fathom::cli {

/// Whether a path names a recording rather than the folder of a data set.
[[nodiscard]] bool is_recording(const std::string& path);

/// The configuration of the fusion service in it, with further overrides.
[[nodiscard]] config::LoadedConfig<config::FusionConfig> configuration_in(
    const std::string& file, const std::vector<std::string>& sets);

/// What the instruments of the configured vehicle said, and the truth as reference: of inertial units the
/// configured one. Sensors keep their names. Damaged parts are named on standard error. Throws Failure.
[[nodiscard]] dataset::Dataset read_recording(const std::string& file, const config::FusionConfig& config);

}  // namespace fathom::cli
