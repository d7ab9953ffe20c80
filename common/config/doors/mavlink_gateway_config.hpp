#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "config/common_config.hpp"
#include "config/registry.hpp"
#include "runtime/byte_link.hpp"

namespace fathom::config {

/// Which frame an autopilot expects a pose from outside in.
enum class MavlinkFrame : std::uint8_t {
  local_ned = 0,  ///< MAV_FRAME_LOCAL_NED, as PX4 has it
  local_frd = 1,  ///< MAV_FRAME_LOCAL_FRD, as ArduPilot has it; forward is north
};

/// Section "messages": how often what is said. 0: never.
struct MavlinkRates {
  double odometry_hz = 30.0;
  double vision_position_hz = 0.0;
  double gps_input_hz = 0.0;
};

/// Section "signing" of MAVLink 2.
struct MavlinkSigning {
  std::string key_file;  ///< 64 hexadecimal digits; empty: nothing is signed, nothing has to be
  int link = 0;
};

/// Where local coordinates begin.
struct MavlinkOrigin {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;  ///< above the ellipsoid
};

/// deploy/config/mavlink_gateway.json
struct MavlinkGatewayConfig {
  CommonConfig common;
  runtime::ByteLinkConfig link;
  int system_id = 1;
  int component_id = 197;  ///< MAV_COMP_ID_VISUAL_INERTIAL_ODOMETRY
  MavlinkFrame frame = MavlinkFrame::local_ned;
  MavlinkRates messages;
  std::optional<MavlinkOrigin> origin;  ///< none: the first position that is valid
  double geoid_height_m = 0.0;          ///< of the sea level above the ellipsoid, for GPS_INPUT
  double valid_95_m = 100.0;
  double valid_heading_rad = 0.174533;
  std::array<double, 3> point_B_m{0.0, 0.0, 0.0};
  MavlinkSigning signing;
};

[[nodiscard]] ConfigKind mavlink_gateway_kind();

}  // namespace fathom::config
