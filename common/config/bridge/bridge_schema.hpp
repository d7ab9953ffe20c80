#pragma once

// For *_config.cpp of bridges: the file of a bridge, and what every instrument plans alike.

#include <set>
#include <string>
#include <utility>

#include "base/units.hpp"
#include "config/bridge/bridge_config.hpp"
#include "config/scenario/sensor_schema.hpp"
#include "config/service_schema.hpp"

namespace fathom::config {

/// What the port of an instrument should be where another has it and not both say that it is shared, or not
/// with the same settings.
[[nodiscard]] inline std::string port_of_its_own(const std::string& other) {
  return "a port of its own: " + other +
         " reads from it as well; where one line carries both, the same port with shared: true in each";
}

void describe(Schema<AsciiConfig>& s);
void describe(Schema<BeaconConfig>& s);

template <class Sensor>
void describe(Schema<BridgeConfig<Sensor>>& s) {
  using Config = BridgeConfig<Sensor>;
  s.include(&Config::common);
  s.field("sensors", &Config::sensors, "the instruments").required();
  s.check([](const Config& config) -> std::pair<std::string, std::string> {
    if (config.sensors.empty()) return {"sensors", "at least one instrument"};
    std::set<std::string> names;
    for (const Sensor& each : config.sensors) {
      if (!names.insert(each.sensor.name.str()).second)
        return {"sensors", "different names for its instruments"};
    }
    for (std::size_t i = 0; i < config.sensors.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const SensorConfig& one = config.sensors[i].sensor;
        const SensorConfig& other = config.sensors[k].sensor;
        if (runtime::collide(one.source, other.source))
          return {"sensors." + std::to_string(i) + ".source", port_of_its_own(other.name.str())};
      }
    }
    return {};
  });
}

/// The part of a plan that does not depend on the kind.
[[nodiscard]] SensorPlan plan_of(const SensorConfig& sensor);

}  // namespace fathom::config
