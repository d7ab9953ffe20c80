// What a navigation state becomes for those who read NMEA 0183, and when it is said.

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "nmea_out/report.hpp"
#include "nmea_out/schedule.hpp"

namespace fathom::nmea_out {
namespace {

using config::NmeaSentence;
using exchange::Quality;
using exchange::nmea::Validity;
using ::testing::HasSubstr;

NavState state_at(double heading_deg, double speed_m_s = 2.0) {
  NavState s;
  s.header = {"auv", "fusion", *from_civil({2026, 1, 2, 3, 4, 5}), 0, 1};
  s.mode = NavMode::gps_aided;
  s.alignment = AlignmentPhase::aligned;
  s.latitude_rad = -30.0 * kRadPerDeg;
  s.longitude_rad = 179.9999 * kRadPerDeg;
  s.altitude_m = -20.0;
  s.depth_m = 20.0;
  s.altitude_above_bottom_m = 7.0;
  const double yaw = heading_deg * kRadPerDeg;
  s.velocity_N_m_s = {speed_m_s * std::cos(yaw), speed_m_s * std::sin(yaw), 0.0};
  s.rpy_rad = {0.0, 0.0, yaw};
  s.q_NB = {std::cos(0.5 * yaw), 0.0, 0.0, std::sin(0.5 * yaw)};
  s.angular_rate_B_rad_s = {0.0, 0.0, 1.0 * kRadPerDeg};
  s.position_covariance_N_m2 = {4.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.25};
  s.velocity_covariance_N_m2_s2 = {0.01, 0, 0, 0, 0.04, 0, 0, 0, 0.01};
  s.rpy_sigma_rad = {0.1 * kRadPerDeg, 0.2 * kRadPerDeg, 0.5 * kRadPerDeg};
  s.gps_outage_s = 0.1;
  return s;
}

TEST(NmeaReport, TellsTheState) {
  const Report report = report_of(state_at(90.0), {});
  EXPECT_EQ(report.validity, Validity::valid);
  EXPECT_EQ(report.point.quality, Quality::fix_3d);
  EXPECT_NEAR(report.point.latitude_deg, -30.0, 1e-12);
  EXPECT_NEAR(report.point.heading_deg, 90.0, 1e-12);
  EXPECT_NEAR(report.forward_m_s, 2.0, 1e-12);
  EXPECT_NEAR(report.starboard_m_s, 0.0, 1e-12);
  EXPECT_NEAR(report.turn_deg_per_min, 60.0, 1e-9);
  EXPECT_NEAR(report.uncertainty.radius_95_m, 2.0 * std::sqrt(-2.0 * std::log(0.05)), 0.01);
  EXPECT_NEAR(report.uncertainty.velocity_sigma_m_s, 0.2, 1e-12);
  EXPECT_NEAR(report.uncertainty.tilt_sigma_deg, 0.2, 1e-12);
  EXPECT_EQ(report.uncertainty.mode, 'G');
  EXPECT_NEAR(report.below_m + report.uncertainty.depth_m, 27.0, 1e-12);
}

TEST(NmeaReport, APointOfTheVehicleMovesWithItInEveryOctant) {
  config::NmeaOutConfig config;
  config.point_B_m = {10.0, 0.0, 2.0};
  for (int octant = 0; octant < 8; ++octant) {
    const double heading_deg = 45.0 * octant;
    const NavState state = state_at(heading_deg);
    const Report here = report_of(state, {});
    const Report there = report_of(state, config);
    const auto moved = geo::difference_N(
        {here.point.latitude_deg * kRadPerDeg, here.point.longitude_deg * kRadPerDeg, here.point.altitude_m},
        {there.point.latitude_deg * kRadPerDeg, there.point.longitude_deg * kRadPerDeg,
         there.point.altitude_m});
    EXPECT_NEAR(moved.x(), 10.0 * std::cos(heading_deg * kRadPerDeg), 1e-3);
    EXPECT_NEAR(moved.y(), 10.0 * std::sin(heading_deg * kRadPerDeg), 1e-3);
    EXPECT_NEAR(moved.z(), 2.0, 1e-3);
    // It turns to starboard by a degree a second: the bow goes that way besides.
    EXPECT_NEAR(there.forward_m_s, 2.0, 1e-9);
    EXPECT_NEAR(there.starboard_m_s, 10.0 * kRadPerDeg, 1e-9);
    EXPECT_NEAR(there.below_m, 5.0, 1e-9);
    EXPECT_NEAR(there.uncertainty.depth_m, 22.0, 1e-9);
    EXPECT_THAT(sentence_of(there, NmeaSentence::gga, "IN"), HasSubstr(",S,"));
  }
}

TEST(NmeaReport, IsHonestAboutWhatItRestsOn) {
  NavState state = state_at(10.0);
  state.mode = NavMode::dead_reckoning;
  Report report = report_of(state, {});
  EXPECT_EQ(report.point.quality, Quality::estimated);
  EXPECT_EQ(report.validity, Validity::valid) << "reckoned, and within the limit";
  EXPECT_THAT(sentence_of(report, NmeaSentence::rmc, "IN"), ::testing::ContainsRegex(",A,.*,E\\*"));

  state.position_covariance_N_m2[0] = 1e4;  // 95 % at 196 m and more
  report = report_of(state, {});
  EXPECT_EQ(report.validity, Validity::not_valid);
  EXPECT_THAT(sentence_of(report, NmeaSentence::rmc, "IN"), ::testing::ContainsRegex(",V,.*,E\\*"));
  EXPECT_THAT(sentence_of(report, NmeaSentence::gga, "IN"), HasSubstr(",E,6,"))
      << "east of Greenwich, by four seconds of arc";
}

TEST(NmeaReport, NothingIsMadeUpWhereThereIsNoPositionOrHeading) {
  for (const NavMode mode : {NavMode::none, NavMode::aligning}) {
    NavState state = state_at(10.0);
    state.mode = mode;
    const Report report = report_of(state, {});
    EXPECT_EQ(report.point.quality, Quality::none);
    EXPECT_EQ(report.validity, Validity::not_valid);
    EXPECT_FALSE(known(report.point.latitude_deg));
    EXPECT_FALSE(known(report.uncertainty.radius_95_m));
    EXPECT_EQ(known(report.point.heading_deg), mode == NavMode::aligning);
  }
  NavState state = state_at(10.0);
  state.latitude_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(report_of(state, {}).point.quality, Quality::none);
  state = state_at(10.0);
  state.position_covariance_N_m2.fill(kUnknown);
  EXPECT_EQ(report_of(state, {}).validity, Validity::not_valid) << "an unknown sigma vouches for nothing";
  state = state_at(10.0);
  state.rpy_sigma_rad[2] = 30.0 * kRadPerDeg;
  EXPECT_FALSE(known(report_of(state, {}).point.heading_deg));
  EXPECT_FALSE(known(report_of(state, {}).forward_m_s));
  EXPECT_NEAR(report_of(state, {}).uncertainty.heading_sigma_deg, 30.0, 1e-9);
}

TEST(NmeaSchedule, SentencesFallOnWholePeriods) {
  config::NmeaOutputConfig output;
  output.sentences = {{NmeaSentence::gga, 5.0}, {NmeaSentence::hdt, 10.0}, {NmeaSentence::zda, 1.0}};
  Schedule schedule(output);
  int gga = 0;
  int hdt = 0;
  int zda = 0;
  const TimeNs start = state_at(0.0).header.stamp_ns;
  for (int i = 0; i < 1000; ++i) {  // 10 s at 100 Hz, a little off the grid
    const std::string text = schedule.due(nothing_at(start + 3'000'000 + i * (kNsPerSecond / 100)));
    gga += text.find("GGA") != std::string::npos ? 1 : 0;
    hdt += text.find("HDT") != std::string::npos ? 1 : 0;
    zda += text.find("ZDA") != std::string::npos ? 1 : 0;
    if (text.find("ZDA") != std::string::npos) {
      EXPECT_THAT(text, HasSubstr(".003,"));
      EXPECT_LT(text.find("GGA"), text.find("ZDA")) << "in the order of the configuration";
    }
  }
  EXPECT_EQ(gga, 50);
  EXPECT_EQ(hdt, 100);
  EXPECT_EQ(zda, 10);
  // The clock is set back by an hour: it goes on at once.
  EXPECT_FALSE(schedule.due(nothing_at(start - 3600 * kNsPerSecond)).empty());
}

}  // namespace
}  // namespace fathom::nmea_out
