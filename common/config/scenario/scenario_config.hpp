#pragma once

#include <string>
#include <vector>

#include "config/json/error.hpp"
#include "config/registry.hpp"
#include "sim/scenario.hpp"

namespace fathom::config {

/// deploy/config/scenarios/NAME.json. Throws ConfigError.
[[nodiscard]] sim::Scenario load_scenario(const LoadRequest& request);

/// The folder with the scenarios: beside the executable (build tree or installed) or in the environment's
/// FATHOM_SCENARIO_DIR. Empty when there is none.
[[nodiscard]] std::string scenario_directory();

/// The file of a scenario given by its name, or by a path (anything with a slash or ending in .json).
/// `directory` empty: scenario_directory(). Throws ConfigError naming the scenarios that exist.
[[nodiscard]] std::string scenario_file(const std::string& name, const std::string& directory = "");

/// Names of the scenarios in a folder, sorted.
[[nodiscard]] std::vector<std::string> scenario_names(const std::string& directory = "");

[[nodiscard]] ConfigKind scenario_kind();

}  // namespace fathom::config
