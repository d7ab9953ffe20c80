// What consumers of ROS 2 expect of navigation: REP-103, REP-105, REP-145 and robot_localization.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "ros2/output/diagnostics.hpp"
#include "ros2/output/messages.hpp"
#include "unit/ros2/state.hpp"

namespace fathom::ros2 {
namespace {

using test::kStart_ns;
using test::state_at;

const geo::Geodetic kOrigin{36.4 * kRadPerDeg, -121.5 * kRadPerDeg, -3.0};

struct Said {
  explicit Said(const NavState& state, Convention convention = Convention::enu_flu)
      : motion(motion_of(state, convention, kOrigin).value()),
        attitude(attitude_of(state, convention).value()) {
    odom.update(motion.map);
  }
  Motion motion;
  Attitude attitude;
  OdomFrame odom;
  FrameNames names;
  RateNoise noise;
};

/// Symmetric, and no variance is zero or less.
void expect_filled(const Covariance6& c) {
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_GT(c[7 * i], 0.0) << i;
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(c[6 * i + k], c[6 * k + i], 1e-15);
  }
}

TEST(OdometryMessage, HasThePoseInOdomAndTheTwistInTheBody) {
  const Said said(state_at(kOrigin, {0, 0, 90.0 * kRadPerDeg}));
  const Odometry message = odometry(said.motion, said.attitude, said.odom, said.names, said.noise);
  EXPECT_EQ(message.header.frame_id, "odom");
  EXPECT_EQ(message.child_frame_id, "base_link");
  EXPECT_EQ(message.header.stamp.sec, 1'700'000'000) << "the instant of validity";
  // Over ground 1 north, 0.5 east, 0.25 up; heading east: forward is east, left is north.
  EXPECT_NEAR(message.twist.twist.linear.x, 0.5, 1e-12);
  EXPECT_NEAR(message.twist.twist.linear.y, 1.0, 1e-12);
  EXPECT_NEAR(message.twist.twist.linear.z, 0.25, 1e-12);
  EXPECT_NEAR(message.twist.twist.angular.y, -0.02, 1e-15);
  EXPECT_NEAR(message.twist.twist.angular.z, -0.03, 1e-15) << "a turn to the right is negative";
  expect_filled(message.pose.covariance);
  expect_filled(message.twist.covariance);
}

TEST(OdometryMessage, TurnsTheCovarianceWithOdom) {
  Said said(state_at(kOrigin));
  NavState turned = state_at(kOrigin, {0, 0, 90.0 * kRadPerDeg});
  turned.header.stamp_ns += 10 * kNsPerMillisecond;
  said.motion = motion_of(turned, Convention::enu_flu, kOrigin).value();
  said.odom.update(said.motion.map);  // a step of the heading by 90 degrees: odom lies across map
  const Odometry message = odometry(said.motion, said.attitude, said.odom, said.names, said.noise);
  EXPECT_NEAR(message.pose.covariance[0], 1.0, 0.01) << "x of odom lies along north";
  EXPECT_NEAR(message.pose.covariance[7], 4.0, 0.01);
}

TEST(ImuMessage, IsOfRep145) {
  const Said said(state_at(kOrigin));
  const Imu message = imu(said.attitude, said.names, said.noise);
  EXPECT_EQ(message.header.frame_id, "base_link");
  EXPECT_NEAR(message.linear_acceleration.z, 9.8, 1e-12) << "at rest +g along up";
  EXPECT_NEAR(message.linear_acceleration.y, -0.2, 1e-12);
  for (const Covariance3* c : {&message.orientation_covariance, &message.angular_velocity_covariance,
                               &message.linear_acceleration_covariance}) {
    for (const std::size_t i : {0U, 4U, 8U}) EXPECT_GT((*c)[i], 0.0);
  }
}

TEST(NavSatFixMessage, SaysWhetherSatellitesAid) {
  NavState state = state_at(kOrigin);
  const NavSatFix message = nav_sat_fix(Said(state).motion, {});
  EXPECT_EQ(message.status.status, NavSatStatus::kFix);
  EXPECT_NEAR(message.latitude, 36.4, 1e-12);
  EXPECT_NEAR(message.longitude, -121.5, 1e-12);
  EXPECT_NEAR(message.altitude, -3.0, 1e-12);
  EXPECT_EQ(message.position_covariance_type, 3);
  EXPECT_NEAR(message.position_covariance[0], 4.0, 1e-12) << "east first";
  state.mode = NavMode::dead_reckoning;
  EXPECT_EQ(nav_sat_fix(Said(state).motion, {}).status.status, NavSatStatus::kNoFix);
  EXPECT_EQ(nav_sat_fix(Said(state).motion, {}).status.service, 0);
}

TEST(PoseMessage, IsInMap) {
  const Said said(state_at(geo::moved_by(kOrigin, {10.0, 20.0, 5.0})));
  const auto message = pose(said.motion, said.attitude, said.names);
  EXPECT_EQ(message.header.frame_id, "map");
  EXPECT_NEAR(message.pose.pose.position.x, 20.0, 1e-4);
  EXPECT_NEAR(message.pose.pose.position.y, 10.0, 1e-4);
  EXPECT_NEAR(message.pose.pose.position.z, -5.0, 1e-4);
  expect_filled(message.pose.covariance);
  const auto twisted = twist(said.motion, said.attitude, said.names, said.noise);
  EXPECT_EQ(twisted.header.frame_id, "base_link");
  expect_filled(twisted.twist.covariance);
}

TEST(GeoPoseMessage, IsInDegrees) {
  const Said said(state_at(kOrigin));
  const GeoPoseStamped message = geo_pose(said.motion, said.names);
  EXPECT_NEAR(message.pose.position.latitude, 36.4, 1e-12);
  EXPECT_NEAR(message.pose.orientation.z, std::sqrt(0.5), 1e-12) << "heading north";
  const GeoPoseStamped origin = map_origin(kStart_ns, kOrigin, said.names);
  EXPECT_NEAR(origin.pose.position.longitude, -121.5, 1e-12);
  EXPECT_EQ(origin.pose.orientation.w, 1.0);
}

TEST(TimeOf, CountsTheNanosecondsUp) {
  EXPECT_EQ(time_of(1'500'000'000).nanosec, 500'000'000U);
  EXPECT_EQ(time_of(-1).sec, -1);
  EXPECT_EQ(time_of(-1).nanosec, 999'999'999U);
  EXPECT_EQ(time_of(std::int64_t{1} << 62).sec, std::numeric_limits<std::int32_t>::max());
}

const DiagnosticStatus* find(const DiagnosticArray& message, const std::string& name) {
  for (const DiagnosticStatus& status : message.status) {
    if (status.name == name) return &status;
  }
  return nullptr;
}

TEST(Diagnostics, TellOfNavigationServicesAndAlarms) {
  DiagnosticsBook book;
  book.heard(state_at(kOrigin), kStart_ns);
  ServiceStatus status;
  status.header.sensor = "fusion";
  status.state = ServiceState::degraded;
  status.text = "no GPS";
  book.heard(status, kStart_ns);
  Alarm alarm;
  alarm.alarm = "gps_outage";
  alarm.severity = Severity::critical;
  alarm.active = true;
  alarm.text = "No fix.";
  book.heard(alarm);
  const DiagnosticArray now = book.message("auv", kStart_ns);
  ASSERT_NE(find(now, "fathom: navigation"), nullptr);
  EXPECT_EQ(find(now, "fathom: navigation")->level.value, 0);
  EXPECT_EQ(find(now, "fathom: navigation")->hardware_id, "auv");
  ASSERT_NE(find(now, "fathom: fusion"), nullptr);
  EXPECT_EQ(find(now, "fathom: fusion")->level.value, 1);
  EXPECT_EQ(find(now, "fathom: fusion")->message, "no GPS");
  ASSERT_NE(find(now, "fathom alarm: gps_outage"), nullptr);
  EXPECT_EQ(find(now, "fathom alarm: gps_outage")->level.value, 2);

  alarm.active = false;
  book.heard(alarm);
  const DiagnosticArray later = book.message("auv", kStart_ns + 4 * kNsPerSecond);
  EXPECT_EQ(find(later, "fathom alarm: gps_outage"), nullptr);
  EXPECT_EQ(find(later, "fathom: fusion")->level.value, 3) << "stale";
  EXPECT_EQ(find(later, "fathom: navigation")->level.value, 3);
}

}  // namespace
}  // namespace fathom::ros2
