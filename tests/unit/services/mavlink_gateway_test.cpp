// What a navigation state becomes for an autopilot.

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/units.hpp"
#include "config/json/error.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "mavlink_gateway/mavlink_gateway_service.hpp"
#include "mavlink_gateway/messages.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::mavlink_gateway {
namespace {

NavState state_at(double yaw_deg, double pitch_deg = 0.0, double latitude_deg = -33.0) {
  NavState s;
  s.header = {"auv", "fusion", *from_civil({2026, 1, 2, 3, 4, 5, 250'000'000}), 0, 1};
  s.mode = NavMode::gps_aided;
  s.alignment = AlignmentPhase::aligned;
  s.latitude_rad = latitude_deg * kRadPerDeg;
  s.longitude_rad = 151.0 * kRadPerDeg;
  s.altitude_m = 20.0;
  s.rpy_rad = {0.0, pitch_deg * kRadPerDeg, yaw_deg * kRadPerDeg};
  const Eigen::Quaterniond q(Eigen::AngleAxisd(s.rpy_rad[2], Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(s.rpy_rad[1], Eigen::Vector3d::UnitY()));
  s.q_NB = {q.w(), q.x(), q.y(), q.z()};
  s.velocity_N_m_s = {1.0, 2.0, 0.5};
  s.angular_rate_B_rad_s = {0.0, 0.0, 0.1};
  s.position_covariance_N_m2 = {1.0, 0.1, 0.0, 0.1, 4.0, 0.2, 0.0, 0.2, 9.0};
  s.velocity_covariance_N_m2_s2 = {0.01, 0.0, 0.0, 0.0, 0.04, 0.0, 0.0, 0.0, 0.09};
  s.rpy_sigma_rad = {0.01, 0.02, 0.03};
  s.reset_counter = 258;
  return s;
}

TEST(MavlinkMessages, OdometryInEveryOctant) {
  const geo::Geodetic origin{-33.0 * kRadPerDeg, 151.0 * kRadPerDeg, 0.0};
  for (int octant = 0; octant < 8; ++octant) {
    const double yaw = 45.0 * octant * kRadPerDeg;
    const NavState state = state_at(45.0 * octant);
    const auto pose = pose_of(state, {});
    ASSERT_TRUE(pose.has_value());
    const mavlink::Odometry o = odometry_of(*pose, origin, {});
    EXPECT_EQ(o.time_usec, 1'767'323'045'250'000U);
    EXPECT_NEAR(o.z, -20.0, 1e-3) << "down";
    EXPECT_NEAR(o.vx, std::cos(yaw) * 1.0 + std::sin(yaw) * 2.0, 1e-5) << "forward";
    EXPECT_NEAR(o.vy, -std::sin(yaw) * 1.0 + std::cos(yaw) * 2.0, 1e-5) << "to starboard";
    EXPECT_NEAR(o.vz, 0.5, 1e-6);
    EXPECT_NEAR(o.yawspeed, 0.1, 1e-7);
    EXPECT_EQ(o.frame_id, 1);
    EXPECT_EQ(o.child_frame_id, 12);
    EXPECT_EQ(o.reset_counter, 2) << "modulo 256";
    // Upper triangle, row by row: xx xy xz x. x. x. yy ...
    EXPECT_NEAR(o.pose_covariance[0], 1.0, 1e-6);
    EXPECT_NEAR(o.pose_covariance[1], 0.1, 1e-6);
    EXPECT_NEAR(o.pose_covariance[6], 4.0, 1e-6);
    EXPECT_NEAR(o.pose_covariance[7], 0.2, 1e-6);
    EXPECT_NEAR(o.pose_covariance[11], 9.0, 1e-6);
    EXPECT_NEAR(o.pose_covariance[15], 0.0001, 1e-9);
    EXPECT_NEAR(o.pose_covariance[18], 0.0004, 1e-9);
    EXPECT_NEAR(o.pose_covariance[20], 0.0009, 1e-9);
    const double c = std::cos(yaw);
    const double s = std::sin(yaw);
    EXPECT_NEAR(o.velocity_covariance[0], c * c * 0.01 + s * s * 0.04, 1e-6);
    EXPECT_NEAR(o.velocity_covariance[6], s * s * 0.01 + c * c * 0.04, 1e-6);
    EXPECT_NEAR(o.velocity_covariance[1], s * c * 0.03, 1e-6);
    EXPECT_TRUE(std::isnan(o.velocity_covariance[15]));
  }
}

TEST(MavlinkMessages, PlaceIsNorthEastDownInBothHemispheres) {
  for (const double latitude_deg : {-70.0, -1.0, 1.0, 70.0}) {
    NavState state = state_at(0.0, 0.0, latitude_deg);
    const geo::Geodetic origin{latitude_deg * kRadPerDeg, 151.0 * kRadPerDeg, 20.0};
    const geo::Geodetic place = geo::moved_by(origin, {30.0, -40.0, 5.0});
    state.latitude_rad = place.latitude_rad;
    state.longitude_rad = place.longitude_rad;
    state.altitude_m = place.altitude_m;
    const mavlink::VisionPositionEstimate v = vision_of(*pose_of(state, {}), origin);
    EXPECT_NEAR(v.x, 30.0, 1e-4);
    EXPECT_NEAR(v.y, -40.0, 1e-4);
    EXPECT_NEAR(v.z, 5.0, 1e-4);
  }
}

TEST(MavlinkMessages, APointOfTheVehicleIsTold) {
  config::MavlinkGatewayConfig config;
  config.point_B_m = {2.0, 0.0, 0.0};
  const NavState state = state_at(90.0);
  const auto pose = pose_of(state, config);
  const geo::Geodetic origin{state.latitude_rad, state.longitude_rad, state.altitude_m};
  const mavlink::Odometry o = odometry_of(*pose, origin, config);
  EXPECT_NEAR(o.x, 0.0, 1e-4);
  EXPECT_NEAR(o.y, 2.0, 1e-4) << "the bow is east";
  EXPECT_NEAR(o.vx, 2.0, 1e-5);
  EXPECT_NEAR(o.vy, -1.0 + 0.2, 1e-5) << "and turns to starboard";
}

TEST(MavlinkMessages, AReceiverForThoseWhoTakeNothingElse) {
  NavState state = state_at(0.0);
  config::MavlinkGatewayConfig config;
  config.geoid_height_m = 22.5;
  mavlink::GpsInput g = gps_input_of(*pose_of(state, config), config);
  EXPECT_EQ(g.lat, -330'000'000);
  EXPECT_EQ(g.lon, 1'510'000'000);
  EXPECT_NEAR(g.alt, -2.5, 1e-5);
  EXPECT_EQ(g.fix_type, 3);
  EXPECT_EQ(g.yaw, 36'000) << "0 would mean that there is none";
  // 2026-01-02 03:04:05.25 UTC is Friday of GPS week 2399; GPS is 18 s ahead.
  EXPECT_EQ(g.time_week, 2399);
  EXPECT_EQ(g.time_week_ms, 5U * 86'400'000U + 3U * 3'600'000U + 4U * 60'000U + 23'250U);
  EXPECT_NEAR(g.horiz_accuracy, std::sqrt(5.0), 1e-6);
  EXPECT_NEAR(g.speed_accuracy, std::sqrt(0.05), 1e-6);
  state.longitude_rad = 200.0 * kRadPerDeg;
  EXPECT_EQ(gps_input_of(*pose_of(state, config), config).lon, -1'600'000'000);
  config.valid_95_m = 1.0;
  EXPECT_EQ(gps_input_of(*pose_of(state, config), config).fix_type, 0);
}

TEST(MavlinkMessages, NothingIsToldThatIsNotKnown) {
  for (const NavMode mode : {NavMode::none, NavMode::aligning}) {
    NavState state = state_at(0.0);
    state.mode = mode;
    EXPECT_FALSE(pose_of(state, {}).has_value());
  }
  NavState state = state_at(0.0);
  state.position_covariance_N_m2[0] = kUnknown;
  EXPECT_FALSE(pose_of(state, {}).has_value());
  state = state_at(0.0);
  state.rpy_sigma_rad[2] = 0.5;
  EXPECT_FALSE(pose_of(state, {}).has_value());
  state.rpy_sigma_rad[2] = kUnknown;
  EXPECT_FALSE(pose_of(state, {}).has_value());
}

TEST(MavlinkMessages, QualityFallsWithWhatIsNotKnown) {
  EXPECT_EQ(quality_of(0.005, 100.0), 100);
  EXPECT_EQ(quality_of(100.0, 100.0), 1);
  EXPECT_EQ(quality_of(100.1, 100.0), -1);
  EXPECT_EQ(quality_of(kUnknown, 100.0), -1);
  EXPECT_GT(quality_of(1.0, 100.0), quality_of(10.0, 100.0));
}

TEST(MavlinkMessages, TheHeartbeatSaysHowItIs) {
  EXPECT_EQ(heartbeat_of(std::nullopt, false).system_status, 3);
  EXPECT_EQ(heartbeat_of(state_at(0.0), true).system_status, 4);
  EXPECT_EQ(heartbeat_of(state_at(0.0), false).system_status, 5);
  EXPECT_EQ(heartbeat_of(state_at(0.0), true).mavlink_version, 3);
}

TEST(MavlinkKey, AFileThatIsNoneIsNamedAndNotWaitedFor) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "key").c_str(), 0600), 0);
  config::MavlinkSigning signing;
  for (const std::string& path : {folder / "key", folder / "none", std::string("/dev/zero")}) {
    signing.key_file = path;
    EXPECT_THROW((void)key_in(signing, "gateway.json"), config::ConfigError) << path;
  }
}

}  // namespace
}  // namespace fathom::mavlink_gateway
