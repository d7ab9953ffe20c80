// Frames of ROS 2 against poses computed by hand.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "ros2/frames/convention.hpp"
#include "ros2/output/messages.hpp"
#include "unit/ros2/state.hpp"

namespace fathom::ros2 {
namespace {

using test::state_at;

void expect_near(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double within, const char* what = "") {
  EXPECT_NEAR(a.x(), b.x(), within) << what;
  EXPECT_NEAR(a.y(), b.y(), within) << what;
  EXPECT_NEAR(a.z(), b.z(), within) << what;
}

// The nose points north, south, east, west ... and up or down: eight octants, in each of the four quarters of
// the world, 30 m north or south, 40 m east or west, and 12 m above or below the origin.
TEST(Frames, AreRightInAllEightOctantsOfBothHemispheres) {
  for (const double hemisphere : {1.0, -1.0}) {
    for (const double side : {1.0, -1.0}) {
      const geo::Geodetic origin{hemisphere * 36.4 * kRadPerDeg, side * 121.0 * kRadPerDeg, -5.0};
      for (const double n : {1.0, -1.0}) {
        for (const double e : {1.0, -1.0}) {
          for (const double d : {1.0, -1.0}) {
            const Eigen::Vector3d nose_N = Eigen::Vector3d(n, e, d) / std::sqrt(3.0);
            const Eigen::Vector3d right_N = Eigen::Vector3d(-e, n, 0.0) / std::sqrt(2.0);
            const Eigen::Vector3d rpy(0.0, std::asin(-d / std::sqrt(3.0)), std::atan2(e, n));
            const Eigen::Vector3d offset_N(30.0 * n, 40.0 * e, 12.0 * d);
            const NavState state = state_at(geo::moved_by(origin, offset_N), rpy);

            const auto enu = motion_of(state, Convention::enu_flu, origin);
            ASSERT_TRUE(enu.ok()) << enu.error().message;
            expect_near(enu.value().map.pose.position_m, {40.0 * e, 30.0 * n, -12.0 * d}, 1e-3);
            const Eigen::Matrix3d R_WF = geo::to_matrix(enu.value().map.pose.q);
            expect_near(R_WF.col(0), {nose_N.y(), nose_N.x(), -nose_N.z()}, 1e-12, "forward");
            expect_near(R_WF.col(1), {-right_N.y(), -right_N.x(), 0.0}, 1e-12, "left");
            expect_near(R_WF.col(2), geo::cross(R_WF.col(0), R_WF.col(1)), 1e-12, "up");
            EXPECT_GT(R_WF(2, 2), 0.0) << "upright";
            // Velocity (1, 0.5, -0.25) over north, east, down.
            expect_near(R_WF * enu.value().velocity_F_m_s, {0.5, 1.0, 0.25}, 1e-12, "velocity");

            const auto ned = motion_of(state, Convention::ned_frd, origin);
            ASSERT_TRUE(ned.ok());
            expect_near(ned.value().map.pose.position_m, offset_N, 1e-3);
            expect_near(geo::to_matrix(ned.value().map.pose.q).col(0), nose_N, 1e-12);
            expect_near(geo::to_matrix(ned.value().map.pose.q).col(1), right_N, 1e-12);
            EXPECT_NEAR(ned.value().velocity_F_m_s.x(), nose_N.dot(Eigen::Vector3d(1.0, 0.5, -0.25)), 1e-12);
          }
        }
      }
    }
  }
}

TEST(Frames, QuaternionsOfTheCompassPointsAreThoseOfTheBook) {
  const double r = std::sqrt(0.5);
  const auto of = [](double yaw_deg) {
    return quaternion(q_WF(Convention::enu_flu, geo::from_rpy({0.0, 0.0, yaw_deg * kRadPerDeg})));
  };
  const Quaternion east = of(90.0);
  EXPECT_NEAR(east.w, 1.0, 1e-15);
  const Quaternion north = of(0.0);
  EXPECT_NEAR(north.w, r, 1e-15);
  EXPECT_NEAR(north.z, r, 1e-15);
  const Quaternion south = of(180.0);
  EXPECT_NEAR(south.w, r, 1e-15);
  EXPECT_NEAR(south.z, -r, 1e-15);
  const Quaternion west = of(-90.0);
  EXPECT_NEAR(std::abs(west.z), 1.0, 1e-15);
  // Heading east, the right side 90 degrees down: a rotation of 90 degrees about forward, which is +x in
  // both.
  const Quaternion rolled =
      quaternion(q_WF(Convention::enu_flu, geo::from_rpy({90.0 * kRadPerDeg, 0.0, 90.0 * kRadPerDeg})));
  EXPECT_NEAR(rolled.w, r, 1e-15);
  EXPECT_NEAR(rolled.x, r, 1e-15);
  // Heading east, the nose 30 degrees up: about left by -30 degrees.
  const Quaternion up =
      quaternion(q_WF(Convention::enu_flu, geo::from_rpy({0.0, 30.0 * kRadPerDeg, 90.0 * kRadPerDeg})));
  EXPECT_NEAR(up.w, std::cos(15.0 * kRadPerDeg), 1e-15);
  EXPECT_NEAR(up.y, -std::sin(15.0 * kRadPerDeg), 1e-15);
}

TEST(Frames, GoBackToWhereTheyCameFrom) {
  for (const Convention convention : {Convention::enu_flu, Convention::ned_frd}) {
    EXPECT_TRUE((R_WN(convention) * R_WN(convention)).isIdentity());
    EXPECT_TRUE((R_FB(convention) * R_FB(convention)).isIdentity());
    for (double yaw = -3.0; yaw < 3.1; yaw += 0.5) {
      const geo::Quaternion q = geo::from_rpy({0.3, -0.7, yaw});
      const geo::Quaternion back = q_NB(convention, q_WF(convention, q));
      EXPECT_LT(geo::log(back * geo::conjugate(q)).norm(), 1e-12);
      const Eigen::Matrix3d R = R_WN(convention) * geo::to_matrix(q) * R_FB(convention).transpose();
      EXPECT_LT((geo::to_matrix(q_WF(convention, q)) - R).norm(), 1e-12);
      EXPECT_GE(q_WF(convention, q).w, 0.0);
    }
  }
}

TEST(Covariance, OfPlaceTurnsWithTheAxes) {
  const geo::Geodetic origin{0.6, 0.1, 0.0};
  const auto motion = motion_of(state_at(origin), Convention::enu_flu, origin);
  ASSERT_TRUE(motion.ok());
  // North 1, east 4, down 9; north-east 0.5, north-down 0.2, east-down -0.3.
  const Covariance3 expected{4.0, 0.5, 0.3, 0.5, 1.0, -0.2, 0.3, -0.2, 9.0};
  const Covariance3 is = covariance3(motion.value().position_covariance_W);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(is[i], expected[i], 1e-12) << i;
  const auto ned = motion_of(state_at(origin), Convention::ned_frd, origin);
  EXPECT_NEAR(ned.value().position_covariance_W(0, 0), 1.0, 1e-12);
  // NavSatFix has east, north, up whatever the convention.
  EXPECT_NEAR(ned.value().position_covariance_ENU(0, 0), 4.0, 1e-12);
}

TEST(Covariance, OfVelocityTurnsIntoTheBody) {
  const geo::Geodetic origin{0.6, 0.1, 0.0};
  // Heading east: forward is east, left is north.
  const auto motion = motion_of(state_at(origin, {0.0, 0.0, 90.0 * kRadPerDeg}), Convention::enu_flu, origin);
  ASSERT_TRUE(motion.ok());
  expect_near(motion.value().velocity_F_m_s, {0.5, 1.0, 0.25}, 1e-12);
  const Eigen::Matrix3d& c = motion.value().velocity_covariance_F;
  expect_near(c.diagonal(), {0.04, 0.01, 0.09}, 1e-12);
}

TEST(Covariance, OfAttitudeIsAboutTheFixedAxes) {
  const geo::Geodetic origin{0.6, 0.1, 0.0};
  const auto diagonal = [&](const Eigen::Vector3d& rpy, Convention convention) {
    return Eigen::Vector3d(
        attitude_of(state_at(origin, rpy), convention).value().rotation_covariance_W.diagonal());
  };
  // Sigma of roll 1, of pitch 2, of yaw 10 mrad. Heading east, roll is about east (x); heading north about y.
  expect_near(diagonal({0, 0, 90.0 * kRadPerDeg}, Convention::enu_flu), {1e-6, 4e-6, 1e-4}, 1e-15);
  expect_near(diagonal({0, 0, 0}, Convention::enu_flu), {4e-6, 1e-6, 1e-4}, 1e-15);
  expect_near(diagonal({0, 0, 0}, Convention::ned_frd), {1e-6, 4e-6, 1e-4}, 1e-15);
  // The nose straight up, as before heading north: roll and yaw are both about the vertical.
  expect_near(diagonal({0, 90.0 * kRadPerDeg, 0}, Convention::ned_frd), {0.0, 4e-6, 1e-6 + 1e-4}, 1e-12);
}

// The same small rotations, applied to the attitude, spread as the covariance says.
TEST(Covariance, OfAttitudeIsWhatDifferencesGive) {
  const Eigen::Vector3d rpy(0.4, -0.6, 2.0);
  const Eigen::Vector3d sigma(1.0, 2.0, 3.0);
  const geo::Quaternion q = geo::from_rpy(rpy);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  constexpr double kStep = 1e-6;
  for (Eigen::Index i = 0; i < 3; ++i) {
    Eigen::Vector3d moved = rpy;
    moved[i] += kStep;
    const Eigen::Vector3d turn = geo::log(geo::from_rpy(moved) * geo::conjugate(q)) / kStep * sigma[i];
    sum += turn * turn.transpose();
  }
  EXPECT_LT((sum - rotation_covariance_N(q, sigma)).norm(), 1e-5);
}

TEST(Motion, SaysWhatIsMissing) {
  const geo::Geodetic origin{0.6, 0.1, 0.0};
  NavState state = state_at(origin);
  state.mode = NavMode::aligning;
  EXPECT_EQ(motion_of(state, Convention::enu_flu, origin).error().message, "the position is not to be used");
  EXPECT_TRUE(attitude_of(state, Convention::enu_flu).ok());
  state.mode = NavMode::none;
  EXPECT_FALSE(attitude_of(state, Convention::enu_flu).ok());
  state = state_at(origin);
  state.position_covariance_N_m2[4] = kUnknown;
  EXPECT_EQ(motion_of(state, Convention::enu_flu, origin).error().message, "the uncertainty is not known");
  state = state_at(origin);
  state.q_NB = {0.9, 0, 0, 0};
  EXPECT_EQ(attitude_of(state, Convention::enu_flu).error().message, "the attitude is not known");
  state = state_at(origin);
  state.velocity_N_m_s[1] = kUnknown;
  EXPECT_EQ(motion_of(state, Convention::enu_flu, origin).error().message, "the velocity is not known");
}

}  // namespace
}  // namespace fathom::ros2
