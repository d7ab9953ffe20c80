#include "guidance_example/line_of_sight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/units.hpp"

namespace fathom::guidance {
namespace {

constexpr double kPi = std::numbers::pi;

PathState at(double north_m, double east_m, double yaw_rad = 0.0) {
  return {north_m, east_m, 0.0, 0.0, yaw_rad};
}

TEST(LineOfSight, PointsAlongTheLegAndTurnsTowardsIt) {
  LineOfSight path({{100, 0, 5, 1.5}}, {10.0, 5.0, false});
  const SteeringOrder start = path.steer(at(0, 0));
  EXPECT_NEAR(start.course_rad, 0.0, 1e-9);
  EXPECT_EQ(start.depth_m, 5.0);
  EXPECT_EQ(start.speed_m_s, 1.5);
  EXPECT_NEAR(start.distance_to_go_m, 100.0, 1e-9);
  const SteeringOrder right =
      path.steer(at(20, 10));  // 10 m right of the leg, look-ahead 10 m: 45 deg to the left
  EXPECT_NEAR(right.cross_track_m, 10.0, 1e-9);
  EXPECT_NEAR(right.course_rad, 315.0 * kRadPerDeg, 1e-9);
  const SteeringOrder left = path.steer(at(20, -10));
  EXPECT_NEAR(left.cross_track_m, -10.0, 1e-9);
  EXPECT_NEAR(left.course_rad, 45.0 * kRadPerDeg, 1e-9);
}

TEST(LineOfSight, HeadingIsCorrectedForDrift) {
  LineOfSight path({{100, 0, 0, 1.5}}, {10.0, 5.0, false});
  // Heading north, the current sets to the east: course over ground 45 deg, so steer 45 deg to the west.
  EXPECT_NEAR(path.steer({0, 0, 1.0, 1.0, 0.0}).heading_rad, 315.0 * kRadPerDeg, 1e-9);
  EXPECT_NEAR(path.steer({0, 0, 0.1, 0.1, 0.0}).heading_rad, 0.0, 1e-9) << "too slow to tell";
  EXPECT_NEAR(path.steer({0, 0, -1.0, 0.0, 0.0}).heading_rad, 0.0, 1e-9) << "backwards";
}

TEST(LineOfSight, ReachesWaypointsInTurnAndEnds) {
  LineOfSight path({{100, 0, 0, 1.0}, {100, 100, 3, 2.0}}, {10.0, 5.0, false});
  EXPECT_EQ(path.steer(at(0, 0)).waypoint, 0u);
  const SteeringOrder second = path.steer(at(96, 1));
  EXPECT_EQ(second.waypoint, 1u);
  EXPECT_EQ(second.reached, 1u);
  EXPECT_EQ(second.depth_m, 3.0);
  EXPECT_EQ(second.speed_m_s, 2.0);
  const SteeringOrder over = path.steer(at(130, 101));  // never within 5 m, but past it
  EXPECT_TRUE(over.finished);
  EXPECT_EQ(over.speed_m_s, 0.0);
  EXPECT_EQ(path.steer(at(0, 0)).reached, 2u) << "the end is final";
}

TEST(LineOfSight, RepeatsAndSurvivesWaypointsOnTopOfEachOther) {
  LineOfSight path({{10, 0, 0, 1}, {10, 0, 0, 1}, {0, 0, 0, 1}}, {10.0, 2.0, true});
  EXPECT_EQ(path.steer(at(0, 5)).waypoint, 0u);
  EXPECT_EQ(path.steer(at(10, 0)).waypoint, 2u);
  EXPECT_EQ(path.steer(at(0, 0)).waypoint, 0u);
  LineOfSight single({{0, 0, 0, 1}}, {10.0, 2.0, true});
  const SteeringOrder order = single.steer(at(0, 0));
  EXPECT_FALSE(order.finished);
  EXPECT_TRUE(std::isfinite(order.course_rad));
}

TEST(LineOfSight, AVehicleThatObeysEndsUpOnTheSquare) {
  LineOfSight path({{100, 0, 0, 1}, {100, 100, 0, 1}, {0, 100, 0, 1}, {0, 0, 0, 1}}, {10.0, 8.0, false});
  double north = -20.0;
  double east = 30.0;
  double yaw = 3.0;
  double worst_late_cross = 0.0;
  int steps = 0;
  SteeringOrder order;
  std::size_t waypoint = 0;
  int on_leg = 0;
  for (; steps < 10'000 && !order.finished; ++steps) {
    // 1.5 m/s, turning at most 15 deg/s, with 0.3 m/s of current to the south-east.
    const double vn = 1.5 * std::cos(yaw) - 0.2;
    const double ve = 1.5 * std::sin(yaw) + 0.2;
    order = path.steer({north, east, vn, ve, yaw});
    const double turn = std::remainder(order.heading_rad - yaw, 2 * kPi);
    yaw += std::clamp(turn, -0.026, 0.026);
    north += 0.1 * vn;
    east += 0.1 * ve;
    on_leg = order.waypoint == waypoint ? on_leg + 1 : 0;
    waypoint = order.waypoint;
    if (on_leg > 400) worst_late_cross = std::max(worst_late_cross, std::abs(order.cross_track_m));
  }
  EXPECT_TRUE(order.finished);
  EXPECT_EQ(order.reached, 4u);
  EXPECT_LT(worst_late_cross, 1.5);
}

}  // namespace
}  // namespace fathom::guidance
