#include "config/bridge/altimeter_config.hpp"

#include "config/bridge/bridge_schema.hpp"

namespace fathom::config {

void describe(Schema<AltimeterSensorConfig>& s) {
  using C = AltimeterSensorConfig;
  s.include(&C::sensor);
  s.field("require_checksum", &C::require_checksum, "NMEA 0183 sentences without a checksum are refused");
  s.field("max_altitude_m", &C::max_altitude_m, "samples beyond are refused").unit("m").range(1, 12'000);
  s.field("least_confidence_percent", &C::least_confidence_percent,
          "ping: a range of which the device is less sure is unknown")
      .unit("%")
      .range(0, 100)
      .only_for({"ping"});
  s.field("ascii", &C::ascii, "the line's shape; its unit is m").only_for({"ascii_altitude"});
}

template LoadedConfig<AltimeterBridgeConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<AltimeterBridgeConfig>();

ConfigKind altimeter_bridge_kind() {
  return make_kind<AltimeterBridgeConfig>("altimeter_bridge");
}

SensorPlan sensor_plan(const AltimeterSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  out.options.require_checksum = config.require_checksum;
  out.options.least_confidence_percent = config.least_confidence_percent;
  out.options.ascii_scale = config.ascii.scale;
  out.options.ascii_offset = config.ascii.offset;
  out.ascii_prefix = config.ascii.prefix;
  out.limits.depth_m = config.max_altitude_m;
  return out;
}

}  // namespace fathom::config
