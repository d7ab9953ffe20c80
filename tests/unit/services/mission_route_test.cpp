#include "guidance_example/mission_route.hpp"

#include <gtest/gtest.h>

#include "base/units.hpp"

namespace fathom::guidance {
namespace {

const geo::Geodetic kOrigin{36.4 * kRadPerDeg, 127.4 * kRadPerDeg, 0.0};

config::GuidanceConfig mission_of(int count) {
  config::GuidanceConfig config;
  for (int i = 0; i < count; ++i) {
    config::Waypoint point;
    point.north_m = 100.0 * i;
    point.east_m = 50.0;
    point.depth_m = 5.0;
    config.waypoints.push_back(point);
  }
  return config;
}

Route route_at(const std::vector<RouteWaypoint>& mission, std::size_t waypoint, std::size_t reached,
               bool finished = false) {
  SteeringOrder order;
  order.waypoint = waypoint;
  order.reached = reached;
  order.finished = finished;
  Route route = route_of(mission, order, kOrigin, !finished);
  route.header.sensor = "guidance";
  EXPECT_EQ(fault_of(route), RouteFault::none);
  return route;
}

TEST(MissionRoute, LocalWaypointsArePlacedFromWhereGuidanceTookOver) {
  config::GuidanceConfig config = mission_of(2);
  config.waypoints[1].name = "turn";
  const auto mission = mission_waypoints(config, kOrigin);
  ASSERT_EQ(mission.size(), 2U);
  const auto offset = geo::difference_N(kOrigin, {mission[1].latitude_rad, mission[1].longitude_rad, 0.0});
  EXPECT_NEAR(offset.x(), 100.0, 0.01);
  EXPECT_NEAR(offset.y(), 50.0, 0.01);
  EXPECT_EQ(mission[0].name, Name());
  EXPECT_EQ(mission[1].name, Name("turn"));
  EXPECT_EQ(mission[1].depth_m, 5.0);
}

TEST(MissionRoute, GeodeticWaypointsStayWhereTheyAre) {
  config::GuidanceConfig config;
  config.frame = config::WaypointFrame::geodetic;
  config::Waypoint point;
  point.latitude_rad = 0.5;
  point.longitude_rad = 350.0 * kRadPerDeg;
  config.waypoints = {point};
  const auto mission = mission_waypoints(config, kOrigin);
  EXPECT_EQ(mission[0].latitude_rad, 0.5);
  EXPECT_NEAR(mission[0].longitude_rad, -10.0 * kRadPerDeg, 1e-12);
}

TEST(MissionRoute, TheLegBeginsAtTheWaypointBeforeAndTheFirstOneWhereGuidanceTookOver) {
  const auto mission = mission_waypoints(mission_of(4), kOrigin);
  const Route first = route_at(mission, 0, 0);
  EXPECT_EQ(first.active, 0U);
  EXPECT_EQ(first.leg_start_latitude_rad, kOrigin.latitude_rad);
  EXPECT_EQ(first.mission_count, 4U);
  const Route third = route_at(mission, 2, 2);
  EXPECT_EQ(third.active, 2U);
  EXPECT_EQ(third.leg_start_latitude_rad, mission[1].latitude_rad);
  const Route again = route_at(mission, 0, 4);
  EXPECT_EQ(again.active, 0U);
  EXPECT_EQ(again.leg_start_latitude_rad, mission[3].latitude_rad) << "round again, from the last one";
  EXPECT_EQ(route_at(mission, 3, 4, true).active, 4U) << "the last one is passed";
}

TEST(MissionRoute, OfALongMissionThePartAroundTheActiveWaypointIsShown) {
  const auto mission = mission_waypoints(mission_of(200), kOrigin);
  for (std::size_t active = 0; active < mission.size(); ++active) {
    const Route route = route_at(mission, active, active);
    ASSERT_EQ(route.waypoints.size(), Route::kMostWaypoints);
    EXPECT_EQ(route.first_number + route.active, active + 1) << "numbers stay those of the mission";
    ASSERT_LT(route.active, route.waypoints.size());
    EXPECT_EQ(route.waypoints[route.active].latitude_rad, mission[active].latitude_rad);
    EXPECT_EQ(route.mission_count, 200U);
  }
  EXPECT_EQ(route_at(mission, 199, 200, true).active, Route::kMostWaypoints);
}

}  // namespace
}  // namespace fathom::guidance
