#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/unknown.hpp"
#include "config/common_config.hpp"
#include "config/registry.hpp"

namespace fathom::config {

/// What the coordinates of the waypoints are.
enum class WaypointFrame : std::uint8_t {
  geodetic = 0,  ///< latitude and longitude, WGS-84
  local = 1,     ///< metres north and east of where guidance first took over
};

struct Waypoint {
  std::string name;  ///< for people; empty: its number
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double north_m = kUnknown;
  double east_m = kUnknown;
  double depth_m = 0.0;
  double speed_m_s = 1.0;
};

/// When the navigation state is good enough to steer by.
struct GuidanceLimits {
  double max_age_s = 0.5;
  double max_horizontal_95_m = 25.0;
  double max_heading_sigma_rad = 0.0872665;
  bool need_aligned = true;
};

/// deploy/config/guidance_example.json
struct GuidanceConfig {
  CommonConfig common;
  double rate_hz = 5.0;        ///< of the steering orders
  double report_s = 10.0;      ///< progress is logged this often
  double lookahead_m = 15.0;   ///< of the line-of-sight law: short is eager, long is smooth
  double acceptance_m = 10.0;  ///< a waypoint this near counts as reached
  bool repeat = true;          ///< after the last waypoint comes the first
  GuidanceLimits limits;
  WaypointFrame frame = WaypointFrame::local;
  std::vector<Waypoint> waypoints;
};

[[nodiscard]] ConfigKind guidance_kind();

}  // namespace fathom::config
