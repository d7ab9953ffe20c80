// Messages of ROS 2 at the door: what becomes a sample, and what is refused with which reason.

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "ros2/input/samples.hpp"

namespace fathom::ros2 {
namespace {

using ::testing::HasSubstr;

constexpr TimeNs kNow_ns = 1'700'000'000 * kNsPerSecond;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

Header header_at(TimeNs stamp_ns, const std::string& frame = "imu_link") {
  return {{static_cast<std::int32_t>(stamp_ns / kNsPerSecond),
           static_cast<std::uint32_t>(stamp_ns % kNsPerSecond)},
          frame};
}

DoorOptions options() {
  DoorOptions out;
  out.vehicle = "auv";
  out.sensor = "imu";
  out.frame_id = "imu_link";
  return out;
}

const SampleHeader kHeader{"auv", "imu", kNow_ns, kNow_ns, 0};

TEST(Door, GivesVehicleSensorStampAndNumber) {
  Door door(options());
  for (std::uint64_t i = 1; i < 4; ++i) {
    const TimeNs now = kNow_ns + static_cast<TimeNs>(i) * 10 * kNsPerMillisecond;
    auto entry = door.enter(header_at(now - 3 * kNsPerMillisecond), now);
    ASSERT_TRUE(entry.sample) << entry.text;
    door.published(*entry.sample);
    EXPECT_EQ(entry.sample->vehicle, Name("auv"));
    EXPECT_EQ(entry.sample->sensor, Name("imu"));
    EXPECT_EQ(entry.sample->stamp_ns, now - 3 * kNsPerMillisecond);
    EXPECT_EQ(entry.sample->received_ns, now);
    EXPECT_EQ(entry.sample->sequence, i);
  }
}

TEST(Door, RefusesAnotherFrame) {
  Door door(options());
  const auto entry = door.enter(header_at(kNow_ns, "imu"), kNow_ns);
  EXPECT_FALSE(entry.sample);
  EXPECT_EQ(entry.why, Refusal::frame);
  EXPECT_EQ(entry.text, "frame_id is 'imu', expected 'imu_link'");
}

TEST(Door, RefusesTimesThatCannotBe) {
  Door door(options());
  const auto why = [&](TimeNs stamp_ns) { return door.enter(header_at(stamp_ns), kNow_ns); };
  EXPECT_EQ(why(0).why, Refusal::stamp) << "a stamp of zero is none";
  EXPECT_EQ(why(kNow_ns - 11 * kNsPerSecond).why, Refusal::stamp);
  EXPECT_EQ(why(kNow_ns + kNsPerSecond).why, Refusal::stamp);
  EXPECT_THAT(why(kNow_ns + kNsPerSecond).text, HasSubstr("-1.000000 s before the arrival"));
  Header header = header_at(kNow_ns);
  header.stamp.nanosec = 1'000'000'000;
  EXPECT_THAT(door.enter(header, kNow_ns).text, HasSubstr("stamp.nanosec is 1000000000"));
  EXPECT_TRUE(why(kNow_ns - 9 * kNsPerSecond).sample);
}

TEST(Door, RefusesWhatIsNotLaterThanTheLast) {
  Door door(options());
  auto first = door.enter(header_at(kNow_ns), kNow_ns);
  ASSERT_TRUE(first.sample);
  EXPECT_TRUE(door.enter(header_at(kNow_ns), kNow_ns).sample) << "nothing was published yet";
  door.published(*first.sample);
  EXPECT_EQ(door.enter(header_at(kNow_ns), kNow_ns).why, Refusal::repeated);
  EXPECT_EQ(door.enter(header_at(kNow_ns - 1), kNow_ns).why, Refusal::repeated);
  EXPECT_TRUE(door.enter(header_at(kNow_ns + 1), kNow_ns).sample);
}

TEST(Door, StampsOnArrivalWhereAsked) {
  DoorOptions other = options();
  other.stamp_on_arrival = true;
  Door door(other);
  const auto entry = door.enter(header_at(12), kNow_ns);
  ASSERT_TRUE(entry.sample);
  EXPECT_EQ(entry.sample->stamp_ns, kNow_ns);
}

TEST(SigmaOf, KnowsWhatIsNotKnown) {
  EXPECT_TRUE(std::isnan(*sigma_of(0.0)));
  EXPECT_TRUE(std::isnan(*sigma_of(-1.0)));
  EXPECT_EQ(*sigma_of(4.0), 2.0);
  EXPECT_FALSE(sigma_of(-0.5));
  EXPECT_FALSE(sigma_of(kNaN));
  EXPECT_FALSE(sigma_of(kInf));
}

Imu level() {
  Imu out;
  out.header = header_at(kNow_ns);
  out.angular_velocity = {0.1, 0.2, 0.3};
  out.linear_acceleration = {0.5, 0.6, 9.81};
  return out;
}

TEST(ImuSampleOf, TurnsIntoTheBody) {
  ImuRule flu;
  flu.R_BS = {1, 0, 0, 0, -1, 0, 0, 0, -1};
  const auto entry = imu_sample(level(), kHeader, flu);
  ASSERT_TRUE(entry.sample) << entry.text;
  EXPECT_EQ(entry.sample->angular_rate_B_rad_s, (std::array<double, 3>{0.1, -0.2, -0.3}));
  EXPECT_EQ(entry.sample->specific_force_B_m_s2, (std::array<double, 3>{0.5, -0.6, -9.81}))
      << "at rest -g down";
  EXPECT_TRUE(std::isnan(entry.sample->delta_time_s));
}

TEST(ImuSampleOf, RefusesHalfAMeasurement) {
  Imu message = level();
  message.angular_velocity_covariance[0] = -1.0;
  EXPECT_EQ(imu_sample(message, kHeader, {}).why, Refusal::missing);
  EXPECT_THAT(imu_sample(message, kHeader, {}).text, HasSubstr("angular_velocity"));
  message = level();
  message.linear_acceleration_covariance[0] = -1.0;
  EXPECT_THAT(imu_sample(message, kHeader, {}).text, HasSubstr("linear_acceleration"));
  message = level();
  message.angular_velocity.y = kNaN;
  EXPECT_EQ(imu_sample(message, kHeader, {}).why, Refusal::value);
  message = level();
  message.linear_acceleration.z = kInf;
  EXPECT_EQ(imu_sample(message, kHeader, {}).why, Refusal::value);
}

NavSatFix fix() {
  NavSatFix out;
  out.header = header_at(kNow_ns);
  out.status = {NavSatStatus::kFix, NavSatStatus::kGps};
  out.latitude = -33.5;
  out.longitude = 200.0;
  out.altitude = 21.0;
  out.position_covariance = {4.0, 0, 0, 0, 9.0, 0, 0, 0, 25.0};
  out.position_covariance_type = 2;
  return out;
}

TEST(GpsSampleOf, HasNorthFirst) {
  const auto entry = gps_sample(fix(), kHeader);
  ASSERT_TRUE(entry.sample) << entry.text;
  EXPECT_EQ(entry.sample->fix, GpsFix::fix_3d);
  EXPECT_NEAR(entry.sample->latitude_rad, -33.5 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(entry.sample->longitude_rad, -160.0 * kRadPerDeg, 1e-12);
  EXPECT_EQ(entry.sample->altitude_m, 21.0);
  EXPECT_EQ(entry.sample->position_sigma_N_m, (std::array<double, 3>{3.0, 2.0, 5.0}));
}

TEST(GpsSampleOf, SaysThatThereIsNoFix) {
  NavSatFix message = fix();
  message.status.status = NavSatStatus::kNoFix;
  message.latitude = kNaN;
  const auto entry = gps_sample(message, kHeader);
  ASSERT_TRUE(entry.sample) << entry.text;
  EXPECT_EQ(entry.sample->fix, GpsFix::none);
  EXPECT_TRUE(std::isnan(entry.sample->latitude_rad));
}

TEST(GpsSampleOf, KnowsNoSigmaWhereNoneIsGiven) {
  NavSatFix message = fix();
  message.position_covariance_type = NavSatFix::kUnknownCovariance;
  EXPECT_TRUE(std::isnan(gps_sample(message, kHeader).sample->position_sigma_N_m[0]));
  message = fix();
  message.position_covariance = {};
  EXPECT_TRUE(std::isnan(gps_sample(message, kHeader).sample->position_sigma_N_m[0]));
  message.position_covariance[0] = -4.0;
  EXPECT_EQ(gps_sample(message, kHeader).why, Refusal::covariance);
}

TEST(GpsSampleOf, RefusesPlacesThatAreNowhere) {
  for (const auto& [lat, lon] :
       {std::pair{91.0, 0.0}, {0.0, 361.0}, {kNaN, 0.0}, {0.0, kNaN}, {0.0, -180.5}}) {
    NavSatFix message = fix();
    message.latitude = lat;
    message.longitude = lon;
    EXPECT_EQ(gps_sample(message, kHeader).why, Refusal::value) << lat << " " << lon;
  }
  NavSatFix message = fix();
  message.altitude = kInf;
  EXPECT_EQ(gps_sample(message, kHeader).why, Refusal::value);
  message.altitude = kNaN;
  EXPECT_TRUE(gps_sample(message, kHeader).sample) << "a fix in two dimensions";
}

TEST(DepthSampleOf, IsDepthOfSeaWater) {
  FluidPressure message;
  message.fluid_pressure = 101'325.0 + 1.0e6;
  message.variance = 1.0e4;
  const auto entry = depth_sample(message, kHeader, {36.4 * kRadPerDeg, 101'325.0});
  ASSERT_TRUE(entry.sample) << entry.text;
  EXPECT_NEAR(entry.sample->depth_m, 99.2, 0.3);  // 100 dbar
  EXPECT_NEAR(entry.sample->sigma_m, 0.0099, 0.0002);
  EXPECT_EQ(entry.sample->pressure_Pa, message.fluid_pressure);
}

TEST(DepthSampleOf, RefusesWhatNoSeaHas) {
  FluidPressure message;
  for (const double pressure : {0.0, -5.0, 3.0e8, kNaN, kInf}) {
    message.fluid_pressure = pressure;
    EXPECT_EQ(depth_sample(message, kHeader, {}).why, Refusal::value) << pressure;
  }
  message.fluid_pressure = 2.0e5;
  message.variance = -2.0;
  EXPECT_EQ(depth_sample(message, kHeader, {}).why, Refusal::covariance);
  message.variance = -1.0;
  EXPECT_TRUE(std::isnan(depth_sample(message, kHeader, {}).sample->sigma_m));
}

Dvl dvl() {
  Dvl out;
  out.header = header_at(kNow_ns);
  out.velocity_mode = Dvl::kBottom;
  out.velocity = {1.0, 0.2, 0.3};
  out.velocity_covar.fill(-1.0);
  out.altitude = 12.5;
  out.num_good_beams = 4;
  out.sound_speed = 1500.0F;
  out.beam_ranges_valid = true;
  out.range = {14.0, 14.5, -1.0, kNaN};
  return out;
}

TEST(DvlSampleOf, PointsWhereTheInstrumentPoints) {
  const auto entry = dvl_sample(dvl(), kHeader, {});
  ASSERT_TRUE(entry.sample) << entry.text;
  EXPECT_EQ(entry.sample->mode, DvlMode::bottom);
  EXPECT_EQ(entry.sample->velocity_D_m_s, (std::array<double, 3>{1.0, 0.2, 0.3}));
  EXPECT_TRUE(std::isnan(entry.sample->sigma_m_s)) << "-1 says that it is not known";
  EXPECT_EQ(entry.sample->altitude_m, 12.5);
  EXPECT_EQ(entry.sample->sound_speed_m_s, 1500.0);
  EXPECT_EQ(entry.sample->beam_range_m[1], 14.5);
  EXPECT_TRUE(std::isnan(entry.sample->beam_range_m[2]) && std::isnan(entry.sample->beam_range_m[3]));
  const auto up = dvl_sample(dvl(), kHeader, {Axes::flu, DvlMode::bottom});
  EXPECT_EQ(up.sample->velocity_D_m_s, (std::array<double, 3>{1.0, -0.2, -0.3}));
}

TEST(DvlSampleOf, HasNoVelocityWithoutBeams) {
  Dvl message = dvl();
  message.num_good_beams = 2;
  message.velocity.x = kNaN;
  message.altitude = -1.0;
  message.velocity_mode = Dvl::kWater;
  const auto entry = dvl_sample(message, kHeader, {});
  ASSERT_TRUE(entry.sample) << entry.text;
  EXPECT_EQ(entry.sample->mode, DvlMode::water);
  EXPECT_TRUE(std::isnan(entry.sample->velocity_D_m_s[0]));
  EXPECT_TRUE(std::isnan(entry.sample->altitude_m));
}

TEST(DvlSampleOf, RefusesWhatItDoesNotUnderstand) {
  Dvl message = dvl();
  message.velocity_mode = 0;
  EXPECT_THAT(dvl_sample(message, kHeader, {}).text, HasSubstr("velocity_mode is 0, expected 1"));
  message = dvl();
  message.velocity.z = kInf;
  EXPECT_EQ(dvl_sample(message, kHeader, {}).why, Refusal::value);
  message = dvl();
  message.velocity_covar[4] = -3.0;
  EXPECT_EQ(dvl_sample(message, kHeader, {}).why, Refusal::covariance);
}

TEST(DvlSampleOf, TakesATwist) {
  TwistWithCovarianceStamped message;
  message.twist.twist.linear = {1.0, 0.5, 0.25};
  message.twist.covariance[0] = 0.01;
  message.twist.covariance[7] = 0.04;
  message.twist.covariance[14] = 0.07;
  const auto entry = dvl_sample(message, kHeader, {Axes::flu, DvlMode::water});
  ASSERT_TRUE(entry.sample) << entry.text;
  EXPECT_EQ(entry.sample->mode, DvlMode::water);
  EXPECT_EQ(entry.sample->velocity_D_m_s, (std::array<double, 3>{1.0, -0.5, -0.25}));
  EXPECT_NEAR(entry.sample->sigma_m_s, 0.2, 1e-12);
  message.twist.twist.linear.y = kNaN;
  EXPECT_EQ(dvl_sample(message, kHeader, {Axes::flu, DvlMode::water}).why, Refusal::value);
}

PoseWithCovarianceStamped pose_at(double x, double y, double xx, double yy, double xy = 0.0) {
  PoseWithCovarianceStamped out;
  out.pose.pose.position = {x, y, -40.0};
  out.pose.covariance[0] = xx;
  out.pose.covariance[7] = yy;
  out.pose.covariance[1] = out.pose.covariance[6] = xy;
  return out;
}

TEST(FixOfPose, IsWhereThePoseIsInMapWhateverItsAxes) {
  const geo::Geodetic origin{-33.5 * kRadPerDeg, 179.9999 * kRadPerDeg, 12.0};
  for (const Convention convention : {Convention::enu_flu, Convention::ned_frd}) {
    const auto entry = fix_sample(pose_at(300.0, 400.0, 4.0, 4.0), kHeader, {origin, convention});
    ASSERT_TRUE(entry.sample) << entry.text;
    const bool enu = convention == Convention::enu_flu;
    geo::Geodetic at{entry.sample->latitude_rad, entry.sample->longitude_rad, origin.altitude_m};
    EXPECT_LE(at.longitude_rad, std::numbers::pi);
    EXPECT_GE(at.longitude_rad, -std::numbers::pi);
    const Eigen::Vector3d north_east = geo::difference_N(origin, at);
    EXPECT_NEAR(north_east.x(), enu ? 400.0 : 300.0, 1e-3);
    EXPECT_NEAR(north_east.y(), enu ? 300.0 : 400.0, 1e-3);
    EXPECT_EQ(entry.sample->sigma_m, 2.0);
    EXPECT_TRUE(std::isnan(entry.sample->depth_m)) << "a height above the ellipsoid is no depth";
  }
}

TEST(FixOfPose, CountsByTheLongestAxisOfItsEllipse) {
  // Axes of 5 m and 1 m, turned by 30 degrees.
  const double c = std::cos(30 * kRadPerDeg);
  const double s = std::sin(30 * kRadPerDeg);
  const auto entry = fix_sample(pose_at(0, 0, 25 * c * c + s * s, 25 * s * s + c * c, 24 * c * s), kHeader,
                                {geo::Geodetic{}, Convention::enu_flu});
  ASSERT_TRUE(entry.sample) << entry.text;
  EXPECT_NEAR(entry.sample->sigma_m, 5.0, 1e-12);
}

TEST(FixOfPose, NeedsAPlaceAndACovariance) {
  const PoseRule rule;
  EXPECT_EQ(fix_sample(pose_at(kNaN, 0, 1, 1), kHeader, rule).why, Refusal::value);
  EXPECT_EQ(fix_sample(pose_at(2e6, 0, 1, 1), kHeader, rule).why, Refusal::value);
  for (const auto& [xx, yy, xy] :
       {std::array{0.0, 0.0, 0.0}, {-1.0, 1.0, 0.0}, {1.0, kNaN, 0.0}, {1.0, kInf, 0.0}, {1.0, 1.0, 2.0}}) {
    const auto entry = fix_sample(pose_at(0, 0, xx, yy, xy), kHeader, rule);
    ASSERT_FALSE(entry.sample) << xx << " " << yy << " " << xy;
    EXPECT_EQ(entry.why, Refusal::covariance);
    EXPECT_THAT(entry.text, HasSubstr("expected a positive covariance"));
  }
}

}  // namespace
}  // namespace fathom::ros2
