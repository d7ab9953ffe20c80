#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "commission/commission.hpp"

namespace fathom::cli {

/// One key of a configuration and what it should be.
struct Change {
  std::string key;  ///< dotted path in the file: "engine.imu.nominal_rate_hz"
  nlohmann::ordered_json was, value;
};

/// What a patch changes in a fusion configuration; nothing for instruments that it does not list.
[[nodiscard]] std::vector<Change> changes_of(const commission::Patch& patch,
                                             const nlohmann::ordered_json& config);

/// Likewise in the file of a vehicle. Levers become positions, measured from where the inertial unit is said
/// to be.
[[nodiscard]] std::vector<Change> vehicle_changes_of(const commission::Patch& patch,
                                                     const nlohmann::ordered_json& vehicle);

/// The configuration with the changes made.
[[nodiscard]] nlohmann::ordered_json patched(nlohmann::ordered_json config,
                                             const std::vector<Change>& changes);

}  // namespace fathom::cli
