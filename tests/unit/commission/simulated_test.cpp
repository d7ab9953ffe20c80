#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "unit/commission/sabotage.hpp"
#include "unit/commission/vehicle.hpp"

namespace fathom::test {
namespace {

using commission::Finding;
using commission::FindingKind;
using commission::Findings;

commission::Assumed assumed_of_simulated() {
  commission::Assumed out;
  out.configured = true;
  out.imu_rate_hz = 100.0;
  out.gps.configured = out.dvl.configured = out.depth.configured = out.heading.configured = true;
  out.gps.lever_B_m = {0.0, 0.0, -0.4};
  out.dvl.lever_B_m = {0.5, 0.0, 0.2};
  return out;
}

const dataset::Dataset& healthy() {
  static const dataset::Dataset kData = drive(commissioning_vehicle(), 1);
  return kData;
}

TEST(CommissionSimulated, NamesNothingOfAVehicleThatIsAsConfigured) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto found = commission::commission(seed == 1 ? healthy() : drive(commissioning_vehicle(), seed),
                                              assumed_of_simulated());
    EXPECT_EQ(wrongs(found.findings), "") << "seed " << seed;
    EXPECT_TRUE(found.patch.empty()) << "seed " << seed;
  }
}

TEST(CommissionSimulated, NamesEachSabotageAndNothingElse) {
  for (const Sabotage& sabotage : sabotages()) {
    dataset::Dataset data = healthy();
    sabotage.commit(data);
    const auto found = commission::commission(data, assumed_of_simulated());
    const Finding* finding = find(found.findings, sabotage.sensor, sabotage.what);
    ASSERT_NE(finding, nullptr) << sabotage.name << "\n" << wrongs(found.findings);
    EXPECT_EQ(finding->severity, commission::Severity::wrong)
        << sabotage.name << ": " << finding->text << "\n"
        << wrongs(found.findings);
    EXPECT_NE(finding->text.find(sabotage.words), std::string::npos)
        << sabotage.name << ": " << finding->text;
    const std::string all = wrongs(found.findings);
    // A clock that runs wrong shifts everything against it; else there is one fault and one sentence.
    if (sabotage.sensor != "imu" || sabotage.what != "rate") {
      EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 1) << sabotage.name << "\n" << all;
    }
  }
}

TEST(CommissionSimulated, ClaimsNothingThatCirclesInABasinCannotTell) {
  sim::Scenario scenario = commissioning_vehicle();
  scenario.vehicle.kind = sim::VehicleConfig::Kind::rotating_arm;
  scenario.start.depth_m = 1.0;
  scenario.mission = {{0.0, 0.0}, {10.0, 0.5}, {40.0, 1.5}, {80.0, 3.0}};
  scenario.duration_s = 120.0;
  scenario.sensors.of<GpsSample>().enabled = false;
  const auto found = commission::commission(drive(scenario, 1), {});
  EXPECT_EQ(wrongs(found.findings), "");
  const Finding* roll = find(found.findings, "dvl", "mounting_roll");
  ASSERT_NE(roll, nullptr);
  EXPECT_FALSE(roll->known) << roll->text;
  const Finding* depth = find(found.findings, "depth", "sign");
  ASSERT_NE(depth, nullptr);
  EXPECT_FALSE(depth->known) << depth->text;
}

TEST(CommissionSimulated, SaysThatAnInertialUnitWithoutValuesOrWithoutGravityIsWrong) {
  for (const double value : {0.0, kUnknown, 1e300}) {
    dataset::Dataset data;
    for (int i = 0; i < 3000; ++i) {
      ImuSample sample;
      sample.header.stamp_ns = i * 10'000'000LL;
      sample.angular_rate_B_rad_s.fill(value);
      sample.specific_force_B_m_s2.fill(value);
      data.of<ImuSample>().push_back(sample);
    }
    EXPECT_TRUE(commission::any_wrong(commission::commission(data, {}).findings)) << value;
  }
}

}  // namespace
}  // namespace fathom::test
