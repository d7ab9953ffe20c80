#pragma once

#include "config/bridge/bridge_config.hpp"

namespace fathom::config {

struct AltimeterSensorConfig {
  SensorConfig sensor;
  bool require_checksum = true;
  double max_altitude_m = 11'000.0;
  double least_confidence_percent = 50.0;
  AsciiConfig ascii;
};
using AltimeterBridgeConfig = BridgeConfig<AltimeterSensorConfig>;

[[nodiscard]] ConfigKind altimeter_bridge_kind();
[[nodiscard]] SensorPlan sensor_plan(const AltimeterSensorConfig& config);

}  // namespace fathom::config
