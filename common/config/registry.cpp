#include "config/registry.hpp"

#include <array>

#include "config/bridge/altimeter_config.hpp"
#include "config/bridge/bridge_config.hpp"
#include "config/bridge/range_config.hpp"
#include "config/console_config.hpp"
#include "config/discovery_config.hpp"
#include "config/doors/foxglove_config.hpp"
#include "config/doors/mavlink_gateway_config.hpp"
#include "config/doors/nmea_out_config.hpp"
#include "config/doors/ros2_gateway_config.hpp"
#include "config/fusion/fusion_config.hpp"
#include "config/fusion/hydro_config.hpp"
#include "config/guidance_config.hpp"
#include "config/monitor_config.hpp"
#include "config/recorder_config.hpp"
#include "config/scenario/scenario_config.hpp"
#include "config/scenario/simulator_config.hpp"
#include "config/vehicle/catalogue.hpp"
#include "config/vehicle/vehicle_config.hpp"

namespace fathom::config {
namespace {

template <class Config>
ConfigKind bridge(ConfigKind kind) {
  kind.plans = [](const LoadRequest& request) {
    return sensor_plans(load_service_config<Config>(request).value);
  };
  return kind;
}

}  // namespace

std::span<const ConfigKind> config_kinds() {
  static const std::array kKinds{bridge<ImuBridgeConfig>(imu_bridge_kind()),
                                 bridge<DvlBridgeConfig>(dvl_bridge_kind()),
                                 bridge<GpsBridgeConfig>(gps_bridge_kind()),
                                 bridge<DepthBridgeConfig>(depth_bridge_kind()),
                                 bridge<HeadingBridgeConfig>(heading_bridge_kind()),
                                 bridge<UsblBridgeConfig>(usbl_bridge_kind()),
                                 bridge<ActuatorBridgeConfig>(actuator_bridge_kind()),
                                 bridge<AirDataBridgeConfig>(air_data_bridge_kind()),
                                 bridge<AltimeterBridgeConfig>(altimeter_bridge_kind()),
                                 bridge<RangeBridgeConfig>(range_bridge_kind()),
                                 fusion_kind(),
                                 hydro_kind(),
                                 monitor_kind(),
                                 recorder_kind(),
                                 ros2_gateway_kind(),
                                 nmea_out_kind(),
                                 mavlink_gateway_kind(),
                                 foxglove_kind(),
                                 guidance_kind(),
                                 simulator_kind(),
                                 scenario_kind(),
                                 console_kind(),
                                 discovery_kind(),
                                 vehicle_kind(),
                                 catalogue_kind()};
  return kKinds;
}

std::vector<SensorPlan> bridge_plans(std::string_view role, const LoadRequest& request) {
  for (const ConfigKind& kind : config_kinds()) {
    if (kind.name == role && kind.plans != nullptr) return kind.plans(request);
  }
  throw ConfigError(request.file, "role", "\"" + std::string(role) + "\"", "that of a bridge");
}

}  // namespace fathom::config
