#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/json/layers.hpp"
#include "config/registry.hpp"

namespace fathom::config {

/// One value that a service runs with, and where it came from.
struct Provenance {
  std::string key;  ///< dotted path in the service's configuration
  nlohmann::json value;
  Origin origin;
};

/// Every value of a service, in the order of their keys: single values and lists of such. Keys that mean
/// nothing here, such as the noise in metres of a compass, are left out. Throws ConfigError.
[[nodiscard]] std::vector<Provenance> provenance(const ConfigKind& kind, const LoadRequest& request);

}  // namespace fathom::config
