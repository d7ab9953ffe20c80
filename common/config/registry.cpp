#include "config/registry.hpp"

#include <array>

#include "config/bridge/bridge_config.hpp"
#include "config/console_config.hpp"
#include "config/discovery_config.hpp"
#include "config/fusion/fusion_config.hpp"
#include "config/fusion/hydro_config.hpp"
#include "config/guidance_config.hpp"
#include "config/monitor_config.hpp"
#include "config/scenario/scenario_config.hpp"
#include "config/scenario/simulator_config.hpp"

namespace fathom::config {

std::span<const ConfigKind> config_kinds() {
  static const std::array kKinds{
      imu_bridge_kind(),     dvl_bridge_kind(),  gps_bridge_kind(),      depth_bridge_kind(),
      heading_bridge_kind(), usbl_bridge_kind(), actuator_bridge_kind(), air_data_bridge_kind(),
      fusion_kind(),         hydro_kind(),       monitor_kind(),         guidance_kind(),
      simulator_kind(),      scenario_kind(),    console_kind(),         discovery_kind()};
  return kKinds;
}

}  // namespace fathom::config
