#pragma once

#include <vector>

#include "config/guidance_config.hpp"
#include "geo/wgs84.hpp"
#include "guidance_example/line_of_sight.hpp"
#include "samples/status/route.hpp"

namespace fathom::guidance {

/// The mission's waypoints with their places on the Earth; `origin` is where guidance took over.
[[nodiscard]] std::vector<RouteWaypoint> mission_waypoints(const config::GuidanceConfig& config,
                                                           const geo::Geodetic& origin);

/// What is published of them: all, or of a mission longer than a route the part around the active waypoint.
/// The leg to it begins at the waypoint before, the first one at `origin`. Pure.
[[nodiscard]] Route route_of(const std::vector<RouteWaypoint>& mission, const SteeringOrder& order,
                             const geo::Geodetic& origin, bool repeats);

}  // namespace fathom::guidance
