#include "config/bridge/range_config.hpp"

#include "config/bridge/bridge_schema.hpp"

namespace fathom::config {

void describe(Schema<RangeSensorConfig>& s) {
  using C = RangeSensorConfig;
  s.include(&C::sensor);
  s.field("require_checksum", &C::require_checksum, "sentences without a checksum are refused");
  s.field("beacons", &C::beacons,
          "the beacons whose place is known; ranges to others are published without a place");
  s.field("sound_speed_m_s", &C::sound_speed_m_s, "mean along the path, turns travel time into range")
      .unit("m/s")
      .range(1'350, 1'650);
  s.field("max_range_m", &C::max_range_m, "samples beyond are refused").unit("m").range(1, 100'000);
  s.check([](const C& config) { return wrong_beacons(config.beacons); });
}

template LoadedConfig<RangeBridgeConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<RangeBridgeConfig>();

ConfigKind range_bridge_kind() {
  return make_kind<RangeBridgeConfig>("range_bridge");
}

SensorPlan sensor_plan(const RangeSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  out.options.require_checksum = config.require_checksum;
  out.options.beacons = beacon_options(config.beacons);
  out.options.beacons.sound_speed_m_s = config.sound_speed_m_s;
  out.intermittent = true;  // out of earshot is no fault
  out.limits.acoustic_range_m = config.max_range_m;
  return out;
}

}  // namespace fathom::config
