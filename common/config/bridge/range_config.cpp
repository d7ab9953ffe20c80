#include "config/bridge/range_config.hpp"

#include "config/bridge/bridge_schema.hpp"

namespace fathom::config {

void describe(Schema<BeaconConfig>& s) {
  using C = BeaconConfig;
  s.field("address", &C::address,
          "as the instrument tells it: the number of a modem, A to D of a transponder")
      .required();
  s.field("latitude_deg", &C::latitude_rad, "where it is")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg)
      .required();
  s.field("longitude_deg", &C::longitude_rad, "where it is")
      .unit("deg")
      .range(-180, 180)
      .scaled(kRadPerDeg)
      .required();
  s.field("depth_m", &C::depth_m, "below the surface").unit("m").range(-100, 12'000).required();
  s.check([](const C& beacon) -> std::pair<std::string, std::string> {
    if (beacon.address.empty() || beacon.address.size() > Name::kCapacity)
      return {"address", "1 to 31 characters"};
    return {};
  });
}

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
  s.check([](const C& config) -> std::pair<std::string, std::string> {
    if (config.beacons.size() > codec::BeaconOptions::kMost) return {"beacons", "at most 16 beacons"};
    std::set<std::string> addresses;
    for (const BeaconConfig& beacon : config.beacons) {
      if (!addresses.insert(beacon.address).second)
        return {"beacons", "different addresses, but \"" + beacon.address + "\" comes twice"};
    }
    return {};
  });
}

template LoadedConfig<RangeBridgeConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<RangeBridgeConfig>();

ConfigKind range_bridge_kind() {
  return make_kind<RangeBridgeConfig>("range_bridge");
}

SensorPlan sensor_plan(const RangeSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  out.options.require_checksum = config.require_checksum;
  codec::BeaconOptions& beacons = out.options.beacons;
  beacons.sound_speed_m_s = config.sound_speed_m_s;
  for (const BeaconConfig& one : config.beacons) {
    if (beacons.count < codec::BeaconOptions::kMost)
      beacons.list[beacons.count++] = {std::string_view(one.address), one.latitude_rad, one.longitude_rad,
                                       one.depth_m};
  }
  out.intermittent = true;  // out of earshot is no fault
  out.limits.acoustic_range_m = config.max_range_m;
  return out;
}

}  // namespace fathom::config
