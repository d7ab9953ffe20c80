#pragma once

#include "config/bridge/bridge_config.hpp"

namespace fathom::config {

/// Somebody who tells positions.
struct FixSensorConfig {
  SensorConfig sensor;
  bool require_checksum = false;
  double max_age_s = 3'600.0;
};
using FixBridgeConfig = BridgeConfig<FixSensorConfig>;

[[nodiscard]] ConfigKind fix_bridge_kind();
[[nodiscard]] SensorPlan sensor_plan(const FixSensorConfig& config);

}  // namespace fathom::config
