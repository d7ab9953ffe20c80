#include "guidance_example/mission_route.hpp"

#include <algorithm>
#include <cstddef>

namespace fathom::guidance {
namespace {

// Of a long mission so many passed waypoints are shown: what is still ahead matters more.
constexpr std::size_t kPassedShown = 16;

}  // namespace

std::vector<RouteWaypoint> mission_waypoints(const config::GuidanceConfig& config,
                                             const geo::Geodetic& origin) {
  std::vector<RouteWaypoint> out;
  for (const config::Waypoint& point : config.waypoints) {
    geo::Geodetic place{point.latitude_rad, geo::wrap_pi(point.longitude_rad), 0.0};
    if (config.frame == config::WaypointFrame::local) {
      place = geo::moved_by(origin, {point.north_m, point.east_m, 0.0});
    }
    out.push_back({.name = std::string_view(point.name),
                   .latitude_rad = place.latitude_rad,
                   .longitude_rad = place.longitude_rad,
                   .depth_m = point.depth_m,
                   .speed_m_s = point.speed_m_s});
  }
  return out;
}

Route route_of(const std::vector<RouteWaypoint>& mission, const SteeringOrder& order,
               const geo::Geodetic& origin, bool repeats) {
  const std::size_t active = order.finished ? mission.size() : order.waypoint;
  const std::size_t shown = std::min(mission.size(), Route::kMostWaypoints);
  const std::size_t wanted = active > kPassedShown ? active - kPassedShown : 0;
  const std::size_t first = std::min(wanted, mission.size() - shown);
  const auto begin = mission.begin() + static_cast<std::ptrdiff_t>(first);
  Route route;
  route.active = static_cast<std::uint32_t>(active - first);
  route.repeats = repeats;
  route.first_number = static_cast<std::uint32_t>(first + 1);
  route.mission_count = static_cast<std::uint32_t>(mission.size());
  route.waypoints.assign(begin, begin + static_cast<std::ptrdiff_t>(shown));
  route.leg_start_latitude_rad = origin.latitude_rad;
  route.leg_start_longitude_rad = origin.longitude_rad;
  if (order.reached > 0) {
    const RouteWaypoint& before = mission[(active + mission.size() - 1) % mission.size()];
    route.leg_start_latitude_rad = before.latitude_rad;
    route.leg_start_longitude_rad = before.longitude_rad;
  }
  return route;
}

}  // namespace fathom::guidance
