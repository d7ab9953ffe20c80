#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/explain.hpp"
#include "config/json/error.hpp"

namespace fathom::config {

struct SensorPlan;

/// One kind of configuration file. `name` is the file's stem in deploy/config and deploy/config/schema.
struct ConfigKind {
  std::string_view name;
  std::string (*schema)() = nullptr;                               ///< JSON Schema text
  void (*check)(const LoadRequest&) = nullptr;                     ///< throws ConfigError
  std::vector<FieldRow> (*rows)() = nullptr;                       ///< every key
  std::vector<SensorPlan> (*plans)(const LoadRequest&) = nullptr;  ///< of a bridge: its instruments
  std::string (*effective)(const LoadRequest&) = nullptr;          ///< JSON of all values, defaults included
};

/// Every kind, for the schema writer and for the test that loads all shipped files.
[[nodiscard]] std::span<const ConfigKind> config_kinds();
/// The instruments that the file of a bridge plans, by the bridge's role. Throws ConfigError.
[[nodiscard]] std::vector<SensorPlan> bridge_plans(std::string_view role, const LoadRequest& request);

}  // namespace fathom::config
