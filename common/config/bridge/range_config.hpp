#pragma once

#include "config/bridge/bridge_config.hpp"

namespace fathom::config {

struct RangeSensorConfig {
  SensorConfig sensor;
  bool require_checksum = true;
  std::vector<BeaconConfig> beacons;
  double sound_speed_m_s = 1'500.0;
  double max_range_m = 20'000.0;
};
using RangeBridgeConfig = BridgeConfig<RangeSensorConfig>;

[[nodiscard]] ConfigKind range_bridge_kind();
[[nodiscard]] SensorPlan sensor_plan(const RangeSensorConfig& config);

}  // namespace fathom::config
