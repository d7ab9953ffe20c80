// The frame odom of REP-105.

#include "ros2/frames/odom_frame.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace fathom::ros2 {
namespace {

constexpr DurationNs kPeriod_ns = 10 * kNsPerMillisecond;

/// A vehicle that circles at 1 m/s and 0.1 rad/s.
MapMotion circling(int tick) {
  const double t = 0.01 * tick;
  const double yaw = 0.1 * t;
  MapMotion out;
  out.stamp_ns = kNsPerSecond + tick * kPeriod_ns;
  out.pose.position_m = {10.0 * std::sin(yaw), 10.0 - 10.0 * std::cos(yaw), -5.0};
  out.pose.q = geo::exp({0.0, 0.0, yaw});
  out.velocity_W_m_s = {std::cos(yaw), std::sin(yaw), 0.0};
  out.angular_rate_F_rad_s = {0.0, 0.0, 0.1};
  return out;
}

Eigen::Vector3d base_in_map(const OdomFrame& frame) {
  return frame.map_from_odom().position_m +
         geo::to_matrix(frame.map_from_odom().q) * frame.odom_from_base().position_m;
}

double angle(const geo::Quaternion& a, const geo::Quaternion& b) {
  return geo::log(geo::normalized(a * geo::conjugate(b))).norm();
}

TEST(OdomFrame, IsMapAsLongAsNothingSteps) {
  OdomFrame frame;
  for (int tick = 0; tick < 6000; ++tick) frame.update(circling(tick));
  EXPECT_LT(frame.map_from_odom().position_m.norm(), 1e-4);
  EXPECT_LT(geo::log(frame.map_from_odom().q).norm(), 1e-12);
}

TEST(OdomFrame, PutsAStepOfThePositionIntoMap) {
  OdomFrame frame;
  const Eigen::Vector3d step(25.0, -40.0, 3.0);
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int tick = 0; tick < 3000; ++tick) {
    MapMotion motion = circling(tick);
    if (tick >= 1500) motion.pose.position_m += step;
    frame.update(motion);
    const Eigen::Vector3d now = frame.odom_from_base().position_m;
    if (tick > 0) {
      EXPECT_LT((now - before).norm(), 0.0101) << "never faster than the vehicle, tick " << tick;
    }
    before = now;
    EXPECT_LT((base_in_map(frame) - motion.pose.position_m).norm(), 1e-9);
  }
  EXPECT_LT((frame.map_from_odom().position_m - step).norm(), 1e-4);
}

TEST(OdomFrame, PutsAStepOfTheHeadingIntoMap) {
  OdomFrame frame;
  const geo::Quaternion turn = geo::exp({0.0, 0.0, 0.8});
  geo::Quaternion before;
  for (int tick = 0; tick < 1000; ++tick) {
    MapMotion motion = circling(tick);
    if (tick >= 500) {
      motion.pose.q = geo::normalized(turn * motion.pose.q);
      motion.velocity_W_m_s = geo::to_matrix(turn) * motion.velocity_W_m_s;
      motion.pose.position_m =
          circling(500).pose.position_m +
          geo::to_matrix(turn) * (motion.pose.position_m - circling(500).pose.position_m);
    }
    frame.update(motion);
    if (tick > 0) {
      EXPECT_LT(angle(frame.odom_from_base().q, before), 0.0011) << tick;
    }
    before = frame.odom_from_base().q;
    EXPECT_LT((base_in_map(frame) - motion.pose.position_m).norm(), 1e-9);
    EXPECT_LT(angle(frame.map_from_odom().q * frame.odom_from_base().q, motion.pose.q), 1e-9);
  }
  EXPECT_NEAR(geo::log(frame.map_from_odom().q).z(), 0.8, 1e-6);
  // In odom the circle goes on as if nothing had been: back to the beginning after 20 pi seconds.
  const Eigen::Vector3d expected = circling(999).pose.position_m;
  EXPECT_LT((frame.odom_from_base().position_m - expected).norm(), 0.02);
}

TEST(OdomFrame, LeavesSmallCorrectionsWhereTheyAre) {
  OdomFrame frame;
  frame.update(circling(0));
  MapMotion motion = circling(1);
  motion.pose.q = geo::normalized(geo::exp({0.0, 0.0, 0.01}) * motion.pose.q);
  frame.update(motion);
  EXPECT_LT(geo::log(frame.map_from_odom().q).norm(), 1e-12);
}

TEST(OdomFrame, GoesOnOverAGap) {
  OdomFrame frame;
  frame.update(circling(0));
  frame.update(circling(300));  // 3 s in which it turned by 0.3 rad: no step of the heading
  EXPECT_LT(geo::log(frame.map_from_odom().q).norm(), 1e-12);
  EXPECT_LT((base_in_map(frame) - circling(300).pose.position_m).norm(), 1e-9);
}

}  // namespace
}  // namespace fathom::ros2
