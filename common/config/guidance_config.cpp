#include "config/guidance_config.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "base/units.hpp"
#include "config/service_schema.hpp"

namespace fathom::config {
namespace {

using Fault = std::pair<std::string, std::string>;

}  // namespace

void describe(Schema<Waypoint>& s) {
  s.field("name", &Waypoint::name, "by which people call it; empty: its number in the mission");
  s.field("lat_deg", &Waypoint::latitude_rad, "latitude, in a geodetic frame")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg);
  s.field("lon_deg", &Waypoint::longitude_rad, "longitude, in a geodetic frame")
      .unit("deg")
      .range(-180, 360)
      .scaled(kRadPerDeg);
  s.field("north_m", &Waypoint::north_m, "north of the start, in a local frame").unit("m").range(-1e5, 1e5);
  s.field("east_m", &Waypoint::east_m, "east of the start, in a local frame").unit("m").range(-1e5, 1e5);
  s.field("depth_m", &Waypoint::depth_m, "below the surface, on the way there").unit("m").range(0, 11000);
  s.field("speed_m_s", &Waypoint::speed_m_s, "on the way there").unit("m/s").range(0.05, 50);
}

void describe(Schema<GuidanceLimits>& s) {
  s.field("max_age_s", &GuidanceLimits::max_age_s, "oldest navigation state to steer by")
      .unit("s")
      .range(0.01, 60);
  s.field("max_horizontal_95_m", &GuidanceLimits::max_horizontal_95_m, "largest 95 % radius of the position")
      .unit("m")
      .range(0.01, 1e5);
  s.field("max_heading_sigma_deg", &GuidanceLimits::max_heading_sigma_rad,
          "largest uncertainty of the heading")
      .unit("deg")
      .range(0.001, 180)
      .scaled(kRadPerDeg);
  s.field("need_aligned", &GuidanceLimits::need_aligned, "steer only when navigation is fully aligned");
}

void describe(Schema<GuidanceConfig>& s) {
  s.include(&GuidanceConfig::common);
  s.field("rate_hz", &GuidanceConfig::rate_hz, "of the steering orders").unit("Hz").range(0.2, 50);
  s.field("report_s", &GuidanceConfig::report_s, "progress is logged this often").unit("s").range(0.5, 3600);
  s.field("lookahead_m", &GuidanceConfig::lookahead_m,
          "of the line-of-sight law: short is eager, long is smooth")
      .unit("m")
      .range(0.5, 1e4);
  s.field("acceptance_m", &GuidanceConfig::acceptance_m, "a waypoint this near counts as reached")
      .unit("m")
      .range(0.5, 1e4);
  s.field("repeat", &GuidanceConfig::repeat, "after the last waypoint comes the first");
  s.field("limits", &GuidanceConfig::limits, "when the navigation state is good enough to steer by");
  s.field("frame", &GuidanceConfig::frame,
          "what the waypoints' coordinates are: lat_deg and lon_deg, or north_m and east_m of the start")
      .words({{"geodetic", WaypointFrame::geodetic}, {"local", WaypointFrame::local}})
      .required();
  s.field("waypoints", &GuidanceConfig::waypoints, "in the order of the mission").required();
  s.check([](const GuidanceConfig& config) -> Fault {
    if (config.waypoints.empty()) return {"waypoints", "at least one waypoint"};
    const bool local = config.frame == WaypointFrame::local;
    for (const Waypoint& point : config.waypoints) {
      if (point.name.size() > Name::kCapacity) {
        return {"waypoints", "names of at most " + std::to_string(Name::kCapacity) + " bytes"};
      }
      const bool has_local = known(point.north_m) && known(point.east_m);
      const bool has_geodetic = known(point.latitude_rad) && known(point.longitude_rad);
      const bool has_other = local ? known(point.latitude_rad) || known(point.longitude_rad)
                                   : known(point.north_m) || known(point.east_m);
      if ((local ? !has_local : !has_geodetic) || has_other) {
        return {"waypoints", local ? "north_m and east_m in every waypoint, and no latitude or longitude"
                                   : "lat_deg and lon_deg in every waypoint, and no north_m or east_m"};
      }
    }
    return {};
  });
}

template LoadedConfig<GuidanceConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<GuidanceConfig>();

ConfigKind guidance_kind() {
  return make_kind<GuidanceConfig>("guidance_example");
}

}  // namespace fathom::config
