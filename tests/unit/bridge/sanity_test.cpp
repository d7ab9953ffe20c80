#include "bridge/sanity.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace fathom::bridge {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
const config::SampleLimits kLimits;

ImuSample good_imu() {
  ImuSample out;
  out.angular_rate_B_rad_s = {0.01, -0.02, 0.03};
  out.specific_force_B_m_s2 = {0.1, 0.2, -9.81};
  return out;
}

std::optional<Refusal> why(const AnySample& sample) {
  const std::optional<Refused> refused = refuse(sample, kLimits);
  return refused ? std::optional(refused->why) : std::nullopt;
}

std::string said(const AnySample& sample) {
  const std::optional<Refused> refused = refuse(sample, kLimits);
  return refused ? sentence(*refused) : "";
}

TEST(Refuse, ImuNeedsEveryComponentFiniteAndPossible) {
  EXPECT_FALSE(refuse(good_imu(), kLimits));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double bad : {kUnknown, kInf, -kInf}) {
      ImuSample imu = good_imu();
      imu.angular_rate_B_rad_s[axis] = bad;
      EXPECT_EQ(why(imu), Refusal::not_finite);
      imu = good_imu();
      imu.specific_force_B_m_s2[axis] = bad;
      EXPECT_EQ(why(imu), Refusal::not_finite);
    }
    ImuSample imu = good_imu();
    imu.angular_rate_B_rad_s[axis] = -36.0;
    EXPECT_EQ(why(imu), Refusal::impossible);
    imu = good_imu();
    imu.specific_force_B_m_s2[axis] = 401.0;
    EXPECT_EQ(why(imu), Refusal::impossible);
  }
  ImuSample imu = good_imu();
  imu.delta_time_s = 0.0;
  EXPECT_EQ(why(imu), Refusal::impossible);
}

TEST(Refuse, LostBottomAndLostSkyArePublished) {
  EXPECT_FALSE(refuse(DvlSample{}, kLimits));
  EXPECT_FALSE(refuse(GpsSample{}, kLimits));
}

TEST(Refuse, ImpossibleValuesOfEachKind) {
  DvlSample dvl;
  dvl.velocity_D_m_s = {kUnknown, 25.0, kUnknown};
  EXPECT_EQ(why(dvl), Refusal::impossible);
  dvl.velocity_D_m_s[1] = kInf;
  EXPECT_EQ(why(dvl), Refusal::not_finite);

  GpsSample gps;
  gps.latitude_rad = 1.6;
  EXPECT_EQ(why(gps), Refusal::impossible);
  gps.latitude_rad = 0.5;
  gps.longitude_rad = -3.2;
  EXPECT_EQ(why(gps), Refusal::impossible);
  gps.longitude_rad = -3.1;
  EXPECT_FALSE(refuse(gps, kLimits));
  gps.altitude_m = -5000.0;
  EXPECT_EQ(why(gps), Refusal::impossible);
  gps.altitude_m = 18.0;
  gps.velocity_N_m_s = {301.0, 0.0, 0.0};
  EXPECT_EQ(why(gps), Refusal::impossible);

  DepthSample depth;
  EXPECT_EQ(why(depth), Refusal::not_finite);
  depth.depth_m = -0.4;  // in the air above the water
  EXPECT_FALSE(refuse(depth, kLimits));
  depth.depth_m = 12'000.0;
  EXPECT_EQ(why(depth), Refusal::impossible);

  RangeSample range;
  EXPECT_EQ(why(range), Refusal::not_finite);
  range.range_m = 120.0;
  EXPECT_FALSE(refuse(range, kLimits));  // to a beacon whose place is not known
  range.beacon_latitude_rad = 2.0;
  EXPECT_EQ(why(range), Refusal::impossible);
  range.beacon_latitude_rad = 0.6;
  range.range_m = 20'001.0;
  EXPECT_EQ(why(range), Refusal::impossible);
  FixSample fix;
  EXPECT_EQ(why(fix), Refusal::not_finite);
  fix.latitude_rad = 0.6;
  fix.longitude_rad = 2.2;
  fix.sigma_m = 20.0;
  EXPECT_FALSE(refuse(fix, kLimits));
  fix.depth_m = 12'000.5;
  EXPECT_EQ(why(fix), Refusal::impossible);
  fix.depth_m = 10.0;
  fix.latitude_rad = 1.6;
  EXPECT_EQ(why(fix), Refusal::impossible);
  AltimeterSample altimeter;
  EXPECT_FALSE(refuse(altimeter, kLimits));  // it hears no bottom
  altimeter.altitude_m = 11'000.5;
  EXPECT_EQ(why(altimeter), Refusal::impossible);
  altimeter.altitude_m = -0.5;
  EXPECT_EQ(why(altimeter), Refusal::impossible);

  HeadingSample heading;
  EXPECT_EQ(why(heading), Refusal::not_finite);
  heading.heading_rad = 2.0 * std::numbers::pi;
  EXPECT_EQ(why(heading), Refusal::impossible);
  heading.heading_rad = 0.0;
  EXPECT_FALSE(refuse(heading, kLimits));

  UsblSample usbl;
  EXPECT_EQ(why(usbl), Refusal::not_finite);
  usbl.latitude_rad = 0.6;
  EXPECT_EQ(why(usbl), Refusal::not_finite);
  usbl.longitude_rad = 2.2;
  EXPECT_FALSE(refuse(usbl, kLimits));
  usbl = {};
  usbl.frame = UsblFrame::ned;
  usbl.relative_m = {10.0, 20.0, kUnknown};
  EXPECT_FALSE(refuse(usbl, kLimits));
  usbl.relative_m[1] = 30'000.0;
  EXPECT_EQ(why(usbl), Refusal::impossible);

  PropulsionSample propulsion;
  EXPECT_EQ(why(propulsion), Refusal::not_finite);
  propulsion.rpm = -1200.0;
  EXPECT_FALSE(refuse(propulsion, kLimits));
  propulsion.rpm = 1e6;
  EXPECT_EQ(why(propulsion), Refusal::impossible);

  FinsSample fins;
  EXPECT_EQ(why(fins), Refusal::not_finite);
  fins.stern_rad = 0.1;  // rudder and stern plane may come in different sentences
  EXPECT_FALSE(refuse(fins, kLimits));
  fins.rudder_rad = 3.0;
  EXPECT_EQ(why(fins), Refusal::impossible);
}

TEST(Refuse, NamesTheValueAndWhatWasExpected) {
  ImuSample imu = good_imu();
  imu.angular_rate_B_rad_s[1] = -57.3;
  EXPECT_EQ(said(imu), "angular_rate_B_rad_s[1] is -57.3, expected -35 to 35");
  imu.specific_force_B_m_s2[2] = kUnknown;
  EXPECT_EQ(said(imu), "specific_force_B_m_s2[2] is unknown, expected a number");
  imu = good_imu();
  imu.delta_time_s = 0.0;
  EXPECT_EQ(said(imu), "delta_time_s is 0, expected more than 0");
  DvlSample dvl;
  dvl.altitude_m = -3.5;
  EXPECT_EQ(said(dvl), "altitude_m is -3.5, expected at least 0");
  dvl.altitude_m = kInf;
  EXPECT_EQ(said(dvl), "altitude_m is infinite, expected a number");
  FixSample fix;
  fix.latitude_rad = 37.5;
  fix.longitude_rad = 2.2;
  fix.sigma_m = 20.0;
  EXPECT_EQ(said(fix), "latitude_rad is 37.5, expected -1.5708 to 1.5708");
  EXPECT_EQ(said(FinsSample{}), "rudder_rad is unknown, expected a number");
}

TEST(Mounting, TurnsRatesForcesAndIncrements) {
  config::MountingConfig mounting;
  mounting.frame = config::MountingFrame::flu;
  ImuSample imu = good_imu();
  imu.delta_angle_B_rad = {1.0, 2.0, 3.0};
  rotate_into_body(imu, mounting.rotation());
  EXPECT_NEAR(imu.angular_rate_B_rad_s[1], 0.02, 1e-15);
  EXPECT_NEAR(imu.specific_force_B_m_s2[2], 9.81, 1e-15);
  EXPECT_NEAR(imu.delta_angle_B_rad[2], -3.0, 1e-15);
  EXPECT_FALSE(known(imu.delta_velocity_B_m_s[0]));

  // Turned by 90 degrees to starboard: its forward axis points to the right.
  mounting.frame = config::MountingFrame::frd;
  mounting.rpy_rad = {0.0, 0.0, std::numbers::pi / 2};
  imu = good_imu();
  rotate_into_body(imu, mounting.rotation());
  EXPECT_NEAR(imu.angular_rate_B_rad_s[0], 0.02, 1e-12);
  EXPECT_NEAR(imu.angular_rate_B_rad_s[1], 0.01, 1e-12);
  EXPECT_NEAR(imu.angular_rate_B_rad_s[2], 0.03, 1e-12);
}

}  // namespace
}  // namespace fathom::bridge
