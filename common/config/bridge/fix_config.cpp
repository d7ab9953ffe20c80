#include "config/bridge/fix_config.hpp"

#include <algorithm>

#include "config/bridge/bridge_schema.hpp"

namespace fathom::config {

void describe(Schema<FixSensorConfig>& s) {
  using C = FixSensorConfig;
  s.include(&C::sensor);
  s.field("require_checksum", &C::require_checksum, "lines without a checksum are refused");
  s.field("max_age_s", &C::max_age_s, "a position of longer ago is refused").unit("s").range(1, 7'200);
}

template LoadedConfig<FixBridgeConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<FixBridgeConfig>();

ConfigKind fix_bridge_kind() {
  return make_kind<FixBridgeConfig>("fix_bridge");
}

SensorPlan sensor_plan(const FixSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  // The line names an instant that may be long past.
  out.sensor.time.max_age_s = std::max(out.sensor.time.max_age_s, config.max_age_s);
  out.options.require_checksum = config.require_checksum;
  out.intermittent = true;  // positions are told when somebody has one
  out.dated = true;
  return out;
}

}  // namespace fathom::config
