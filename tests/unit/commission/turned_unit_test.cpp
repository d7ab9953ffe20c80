#include <cmath>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "commission/finding.hpp"
#include "geo/wgs84.hpp"
#include "unit/commission/vehicle.hpp"

namespace fathom::test {
namespace {

using commission::Finding;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d about_z(double angle_deg) {
  return Eigen::AngleAxisd(angle_deg * kRadPerDeg, Vector3d::UnitZ()).toRotationMatrix();
}

// A minute of rest, a circle to either side at changing speed, and a long straight run, all at the surface:
// some of it tells no heading.
dataset::Dataset short_log(std::uint64_t seed) {
  sim::Scenario out = commissioning_vehicle();
  out.mission.resize(1);
  double t = 60.0;
  double heading_deg = 60.0;
  const auto step = [&](double lasts_s, double turn_deg, double speed_m_s) {
    heading_deg += turn_deg;
    sim::MissionStep leg;
    leg.at_s = t;
    leg.heading_rad = geo::wrap_pi(heading_deg * kRadPerDeg);
    leg.speed_m_s = speed_m_s;
    out.mission.push_back(leg);
    t += lasts_s;
  };
  for (const double turn_deg : {60.0, -60.0})
    for (int i = 0; i < 5; ++i) step(10.0, turn_deg, i % 2 != 0 ? 2.5 : 1.0);
  step(60.0, 0.0, 2.0);
  out.duration_s = t;
  return drive(out, seed);
}

const dataset::Dataset& short_healthy() {
  static const dataset::Dataset kData = short_log(1);
  return kData;
}

commission::Assumed as_built() {
  commission::Assumed out;
  out.configured = true;
  out.gps.configured = out.dvl.configured = out.heading.configured = true;
  out.gps.lever_B_m = {0.0, 0.0, -0.4};
  out.dvl.lever_B_m = {0.5, 0.0, 0.2};
  return out;
}

void turn_unit(dataset::Dataset& data, double angle_deg) {
  through(data, about_z(-angle_deg), about_z(-angle_deg));
}

void turn_dvl(dataset::Dataset& data, double angle_deg) {
  dvl_through(data, about_z(-angle_deg));
}

// Of a compass that is mounted turned to the right.
void turn_compass(dataset::Dataset& data, double angle_deg) {
  for (HeadingSample& sample : data.of<HeadingSample>())
    sample.heading_rad = geo::wrap_two_pi(sample.heading_rad + angle_deg * kRadPerDeg);
}

// Sensors that have a wrong finding, each followed by a blank.
std::string at_fault(const commission::Findings& findings) {
  std::string out;
  for (const Finding& finding : findings)
    if (finding.severity == commission::Severity::wrong && out.find(finding.sensor) == std::string::npos)
      out += finding.sensor + " ";
  return out;
}

TEST(CommissionTurnedUnit, IsNamedWhereCompassAndDvlAndTheWayAgreeAgainstIt) {
  for (const double angle_deg : {180.0, 90.0, -90.0}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      dataset::Dataset data = seed == 1 ? short_healthy() : short_log(seed);
      turn_unit(data, angle_deg);
      commission::Assumed assumed = as_built();
      if (seed == 2) {  // the others are built turned, and the configuration says so
        turn_dvl(data, 90.0);
        assumed.dvl.C_BD = about_z(90.0);
        turn_compass(data, -90.0);
        assumed.heading.C_BD = about_z(-90.0);
      }
      const auto found = commission::commission(data, assumed);
      EXPECT_EQ(at_fault(found.findings), "imu ") << angle_deg << " seed " << seed << "\n"
                                                  << wrongs(found.findings);
      ASSERT_TRUE(found.patch.C_BI.has_value()) << angle_deg << " seed " << seed;
      EXPECT_TRUE(found.patch.C_BI->isApprox(about_z(angle_deg), 1e-9))
          << angle_deg << " seed " << seed << "\n"
          << *found.patch.C_BI;
      EXPECT_EQ(find(found.findings, "imu", "turn_z"), nullptr) << angle_deg << " seed " << seed;
    }
  }
}

TEST(CommissionTurnedUnit, IsNamedBesideADvlThatIsTurnedAsWell) {
  dataset::Dataset data = short_healthy();
  turn_unit(data, 180.0);
  turn_dvl(data, 90.0);
  const auto found = commission::commission(data, as_built());
  EXPECT_EQ(at_fault(found.findings), "imu dvl ") << wrongs(found.findings);
  ASSERT_TRUE(found.patch.C_BI.has_value());
  EXPECT_TRUE(found.patch.C_BI->isApprox(about_z(180.0), 1e-9)) << *found.patch.C_BI;
}

TEST(CommissionTurnedUnit, IsNotWhatIsTurnedWhereTheCompassAloneIs) {
  for (const double angle_deg : {180.0, 90.0}) {
    dataset::Dataset data = short_healthy();
    turn_compass(data, angle_deg);
    const auto found = commission::commission(data, as_built());
    EXPECT_EQ(at_fault(found.findings), "heading ") << angle_deg << "\n" << wrongs(found.findings);
    EXPECT_FALSE(found.patch.C_BI.has_value() || found.patch.C_BD.has_value()) << angle_deg;
    ASSERT_TRUE(found.patch.heading_yaw_rad.has_value()) << angle_deg;
    EXPECT_LT(std::abs(geo::wrap_pi(*found.patch.heading_yaw_rad - angle_deg * kRadPerDeg)), 3.0 * kRadPerDeg)
        << angle_deg;
  }
}

TEST(CommissionTurnedUnit, IsNotWhatIsTurnedWhereTheDvlAloneIs) {
  for (const double angle_deg : {180.0, 90.0}) {
    dataset::Dataset data = short_healthy();
    turn_dvl(data, angle_deg);
    const auto found = commission::commission(data, as_built());
    EXPECT_EQ(at_fault(found.findings), "dvl ") << angle_deg << "\n" << wrongs(found.findings);
    EXPECT_FALSE(found.patch.C_BI.has_value() || found.patch.heading_yaw_rad.has_value()) << angle_deg;
  }
}

TEST(CommissionTurnedUnit, IsNotNamedWhereAllSayThatTheVehicleGoesAstern) {
  dataset::Dataset data = short_healthy();
  turn_unit(data, 180.0);
  turn_dvl(data, 180.0);
  turn_compass(data, 180.0);
  commission::Assumed assumed = as_built();
  assumed.dvl.lever_B_m = {-0.5, 0.0, 0.2};
  const auto found = commission::commission(data, assumed);
  EXPECT_EQ(at_fault(found.findings), "") << wrongs(found.findings);
  EXPECT_FALSE(found.patch.C_BI.has_value());
  const Finding* way = find(found.findings, "imu", "travel_yaw");
  ASSERT_NE(way, nullptr);
  EXPECT_LT(std::abs(geo::wrap_pi((way->value - 180.0) * kRadPerDeg)), 10.0 * kRadPerDeg) << way->text;
}

// On one course with starts and stops the log tells that compass and inertial unit are half a turn apart, and
// not which of them is turned: the vehicle may go astern.
TEST(CommissionTurnedUnit, IsNotToldFromATurnedCompassOnOneCourse) {
  sim::Scenario scenario = commissioning_vehicle();
  scenario.mission.resize(1);
  double t = 30.0;
  for (int i = 0; i < 15; ++i, t += 10.0) {
    sim::MissionStep leg = scenario.mission.front();
    leg.at_s = t;
    leg.speed_m_s = i % 2 != 0 ? 2.5 : 0.5;
    scenario.mission.push_back(leg);
  }
  scenario.duration_s = t;
  scenario.sensors.of<DvlSample>().enabled = false;
  const dataset::Dataset as_configured = drive(scenario, 1);
  EXPECT_EQ(find(commission::commission(as_configured, as_built()).findings, "imu", "turn_z"), nullptr);
  for (const bool unit : {true, false}) {
    dataset::Dataset data = as_configured;
    unit ? turn_unit(data, 180.0) : turn_compass(data, 180.0);
    const auto found = commission::commission(data, as_built());
    EXPECT_FALSE(found.patch.C_BI.has_value()) << unit;
    const Finding* turn = find(found.findings, "imu", "turn_z");
    ASSERT_NE(turn, nullptr) << unit;
    EXPECT_FALSE(turn->known) << unit;
    EXPECT_NE(turn->text.find("180 degrees"), std::string::npos) << turn->text;
    EXPECT_NE(turn->text.find("many courses"), std::string::npos) << turn->text;
  }
}

}  // namespace
}  // namespace fathom::test
