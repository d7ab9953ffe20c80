#include "unit/commission/level_boat.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "commission/fit/gps_fit.hpp"
#include "commission/fit/series.hpp"
#include "commission/fit/signed_axes.hpp"
#include "support/sanitized.hpp"
#include "unit/commission/sabotage.hpp"

namespace fathom::test {
namespace {

using commission::Finding;
using commission::Findings;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d from_rpy_deg(double roll, double pitch, double yaw) {
  return geo::to_matrix(geo::from_rpy(Vector3d(roll, pitch, yaw) * kRadPerDeg));
}

commission::Assumed as_built(const LevelBoat& boat) {
  commission::Assumed out;
  out.configured = true;
  out.imu_rate_hz = 100.0;
  out.gps.configured = out.dvl.configured = true;
  out.gps.lever_B_m = boat.gps_lever_B_m;
  out.dvl.lever_B_m = boat.dvl_lever_B_m;
  out.dvl.C_BD = boat.C_BD;
  return out;
}

// Half a turn about the way with the lever on the other side reads the same, whichever of the two is built.
TEST(CommissionLevelBoat, KeepsTheConfiguredMountingWhereHalfATurnExplainsTheLogAsWell) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    sim::Random random(seed, "half a turn");
    LevelBoat boat;
    boat.dvl_lever_B_m.x() = (random.chance(0.5) ? 1.0 : -1.0) * random.uniform(0.3, 0.8);
    const double yaw_deg = 90.0 * std::floor(random.uniform(0.0, 3.999));
    boat.C_BD = from_rpy_deg(random.chance(0.5) ? 180.0 : 0.0, 0.0, yaw_deg);
    const auto found = commission::commission(sail(boat, seed), as_built(boat));
    EXPECT_EQ(wrongs(found.findings), "") << "seed " << seed;
    EXPECT_FALSE(found.patch.C_BD.has_value()) << "seed " << seed << "\n" << *found.patch.C_BD;
    EXPECT_FALSE(found.patch.dvl_lever_B_m.has_value()) << "seed " << seed << "\n"
                                                        << *found.patch.dvl_lever_B_m;
    EXPECT_FALSE(found.patch.dvl_latency_s.has_value()) << "seed " << seed;
    const Vector3d way_D = boat.C_BD.transpose().col(0);
    const Finding* turn =
        find(found.findings, "dvl", std::abs(way_D.x()) > 0.5 ? "mounting_roll" : "mounting_pitch");
    ASSERT_NE(turn, nullptr) << "seed " << seed;
    EXPECT_FALSE(turn->known) << "seed " << seed << " " << turn->text;
    for (const char* const words : {"cannot be told", "Half a turn about the way", "sideways or up and down"})
      EXPECT_NE(turn->text.find(words), std::string::npos) << "seed " << seed << " " << turn->text;
    const Finding* lever = find(found.findings, "dvl", "lever_x");
    ASSERT_NE(lever, nullptr) << "seed " << seed;
    EXPECT_FALSE(lever->known) << "seed " << seed << " " << lever->text;
  }
}

// What the finding asks for tells it.
TEST(CommissionLevelBoat, NamesAnUpsideDownDvlWhereACurrentSetsTheBoatSideways) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    sim::Random random(seed, "upside down");
    LevelBoat boat;
    boat.dvl_lever_B_m.x() = random.uniform(-0.8, 0.8);
    boat.current_north_m_s = random.uniform(0.5, 0.8);
    const commission::Assumed assumed = as_built(boat);
    boat.C_BD = from_rpy_deg(180.0, 0.0, 0.0);
    const auto found = commission::commission(sail(boat, seed), assumed);
    const Finding* roll = find(found.findings, "dvl", "mounting_roll");
    ASSERT_NE(roll, nullptr) << "seed " << seed;
    EXPECT_EQ(roll->severity, commission::Severity::wrong) << "seed " << seed << " " << roll->text;
    ASSERT_TRUE(found.patch.C_BD.has_value()) << "seed " << seed;
    EXPECT_LT(geo::log(geo::from_matrix(boat.C_BD.transpose() * *found.patch.C_BD)).norm(), 3.0 * kRadPerDeg)
        << "seed " << seed << "\n"
        << *found.patch.C_BD;
    EXPECT_FALSE(found.patch.dvl_lever_B_m.has_value()) << "seed " << seed;
  }
}

// The log refutes what is configured, which then does not tell one half turn from the other either.
TEST(CommissionLevelBoat, WritesNoMountingWhereTheLogRefutesTheConfiguredOneAndTellsNotWhichItIs) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    sim::Random random(seed, "backwards");
    LevelBoat boat;
    boat.dvl_lever_B_m.x() = (random.chance(0.5) ? 1.0 : -1.0) * random.uniform(0.3, 0.8);
    const commission::Assumed assumed = as_built(boat);
    boat.C_BD = from_rpy_deg(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0), 180.0);
    const auto found = commission::commission(sail(boat, seed), assumed);
    EXPECT_FALSE(found.patch.C_BD.has_value()) << "seed " << seed << "\n" << *found.patch.C_BD;
    const std::string said = wrongs(found.findings);
    for (const char* const words :
         {"not mounted as configured", "none is written", "sideways or up and down"})
      EXPECT_NE(said.find(words), std::string::npos) << "seed " << seed << " " << said;
  }
}

// Without a lever nothing at all is sideways: the turn about the way is as configured, the others are as
// found.
TEST(CommissionLevelBoat, WritesWhatIsToldAndKeepsTheAngleThatIsNot) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    sim::Random random(seed, "without lever");
    LevelBoat boat;
    boat.C_BD = from_rpy_deg(random.uniform(-3.0, 3.0), 0.0, 0.0);
    const commission::Assumed assumed = as_built(boat);
    boat.C_BD = boat.C_BD * from_rpy_deg(0.0, random.uniform(2.0, 4.0), random.uniform(2.0, 4.0));
    const auto found = commission::commission(sail(boat, seed), assumed);
    EXPECT_EQ(wrongs(found.findings), "") << "seed " << seed;
    ASSERT_TRUE(found.patch.C_BD.has_value()) << "seed " << seed;
    EXPECT_LT(geo::log(geo::from_matrix(boat.C_BD.transpose() * *found.patch.C_BD)).norm(), 0.5 * kRadPerDeg)
        << "seed " << seed << "\n"
        << *found.patch.C_BD;
  }
}

TEST(CommissionLevelBoat, TakesAHorizontalVelocityAsVelocity) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    sim::Random random(seed, "horizontal");
    LevelBoat boat;
    boat.gps_lever_B_m = {random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), -0.5};
    boat.gps_late_s = random.uniform(0.05, 0.25);
    dataset::Dataset data = sail(boat, seed);
    without_vertical(data);
    const auto found = commission::commission(data, as_built(boat));
    EXPECT_EQ(wrongs(found.findings), "") << "seed " << seed;
    const Finding* velocity = find(found.findings, "gps", "velocity_axes");
    ASSERT_NE(velocity, nullptr) << "seed " << seed;
    EXPECT_TRUE(velocity->known) << "seed " << seed << " " << velocity->text;
    EXPECT_NE(velocity->text.find("north, east)"), std::string::npos) << velocity->text;
    EXPECT_NE(velocity->text.find("no vertical velocity"), std::string::npos) << velocity->text;
    const Finding* latency = find(found.findings, "gps", "latency");
    ASSERT_NE(latency, nullptr) << "seed " << seed;
    EXPECT_LT(latency->sigma, 0.02) << "seed " << seed << " " << latency->text;
    EXPECT_NEAR(latency->value, boat.gps_late_s, 4.0 * latency->sigma) << "seed " << seed;
    for (int axis = 0; axis < 2; ++axis) {
      const Finding* lever = find(found.findings, "gps", axis == 0 ? "lever_x" : "lever_y");
      ASSERT_NE(lever, nullptr) << "seed " << seed;
      EXPECT_LT(lever->sigma, 0.1) << "seed " << seed << " " << lever->text;
      EXPECT_NEAR(lever->value, boat.gps_lever_B_m[axis], 4.0 * lever->sigma) << "seed " << seed;
    }
  }
}

// On flat water nothing turns about x and y but the Earth: a receiver that smooths lets it be seen, and that
// is no evidence on how x and y of the gyro stand.
TEST(CommissionLevelBoat, TurnOfTheEarthIsNoEvidenceOnTheAxesOfTheGyro) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    LevelBoat boat;
    boat.gps_velocity_noise_m_s = 0.001;
    const commission::Series series = commission::series_of(sail(boat, seed), as_built(boat));
    const auto windows = commission::windows_of(series, series.gps_velocity, 12.0, 6, 16);
    std::vector<double> squares;
    for (const Matrix3d& axes : commission::signed_axes()) {
      if (axes(2, 2) != 1.0) continue;
      commission::ImuReading reading;
      reading.rate = axes;
      squares.push_back(commission::gps_squares(series, series.gps_velocity, windows, reading, 0.0).as_read);
    }
    const auto [least, most] = std::minmax_element(squares.begin(), squares.end());
    // Six independent figures a window.
    const double log_ratio = 3.0 * static_cast<double>(windows.size()) * std::log(*most / *least);
    EXPECT_LT(log_ratio, 5.0) << "seed " << seed;
  }
}

TEST(CommissionLevelBoat, SaysWhetherTheReceiverGivesAVelocity) {
  dataset::Dataset data = sail({}, 1);
  auto& fixes = data.of<GpsSample>();
  for (std::size_t i = 0; i < fixes.size(); ++i)
    if (i % 3 != 0) fixes[i].velocity_N_m_s.fill(kUnknown);
  const auto some = commission::commission(data, as_built({}));
  EXPECT_NE(find(some.findings, "gps", "velocity_axes")->text.find(" positions only"), std::string::npos);
  for (GpsSample& fix : fixes) fix.velocity_N_m_s.fill(kUnknown);
  const auto none = commission::commission(data, as_built({}));
  EXPECT_NE(find(none.findings, "gps", "velocity_axes")->text.find("gives no velocity;"), std::string::npos);
}

// A vehicle that dives, so that the vertical that the receiver does not give is not zero.
TEST(CommissionLevelBoat, ServesWithoutAVerticalVelocityForAVehicleThatDives) {
  FATHOM_MANY_RUNS();
  const dataset::Dataset healthy = drive(commissioning_vehicle(), 1);
  commission::Assumed assumed = as_built({});
  assumed.depth.configured = assumed.heading.configured = true;
  assumed.gps.lever_B_m = {0.0, 0.0, -0.4};
  assumed.dvl.lever_B_m = {0.5, 0.0, 0.2};
  dataset::Dataset data = healthy;
  without_vertical(data);
  const auto found = commission::commission(data, assumed);
  EXPECT_EQ(wrongs(found.findings), "");
  EXPECT_TRUE(found.patch.empty());
  for (const Sabotage& sabotage : sabotages()) {
    data = healthy;
    sabotage.commit(data);
    without_vertical(data);
    const auto spoilt = commission::commission(data, assumed);
    const Finding* finding = find(spoilt.findings, sabotage.sensor, sabotage.what);
    ASSERT_NE(finding, nullptr) << sabotage.name << "\n" << wrongs(spoilt.findings);
    EXPECT_EQ(finding->severity, commission::Severity::wrong) << sabotage.name << ": " << finding->text;
    if (sabotage.what != "velocity_axes") {
      EXPECT_NE(finding->text.find(sabotage.words), std::string::npos)
          << sabotage.name << ": " << finding->text;
    }
  }
}

constexpr DurationNs kCentury_ns = 3'000'000'000 * kNsPerSecond;

TEST(CommissionClock, RowsWhoseClockLeapsAreLeftOutAndNotThoseThatFollow) {
  dataset::Dataset data = sail(LevelBoat{}, 1);
  const auto whole = commission::series_of(data, {});
  const TimeNs epoch_ns = whole.epoch_ns;
  for (const std::size_t i : {500U, 501U, 900U}) {
    data.of<ImuSample>()[i].header.stamp_ns += kCentury_ns;
    data.of<DvlSample>()[i].header.stamp_ns += kCentury_ns;
  }
  data.of<GpsSample>()[100].header.stamp_ns += kCentury_ns;
  const auto series = commission::series_of(data, {});
  EXPECT_EQ(series.epoch_ns, epoch_ns);
  EXPECT_EQ(series.imu.size(), whole.imu.size() - 3);
  EXPECT_EQ(series.dvl.size(), whole.dvl.size() - 3);
  EXPECT_EQ(series.gps_position.size(), whole.gps_position.size() - 1);
  data.of<ImuSample>().front().header.stamp_ns += kCentury_ns;
  EXPECT_EQ(commission::series_of(data, {}).imu.size(), whole.imu.size() - 4);
}

TEST(CommissionClock, AGapOfACenturyIsNotWalkedThrough) {
  dataset::Dataset data = sail(LevelBoat{}, 1);
  HeadingSample heading;
  for (const ImuSample& sample : data.of<ImuSample>()) {
    heading.header = sample.header;
    heading.heading_rad = 1.0;
    data.of<HeadingSample>().push_back(heading);
  }
  data.of<ImuSample>().back().header.stamp_ns += kCentury_ns;
  const auto found = commission::commission(data, {});
  EXPECT_FALSE(found.findings.empty());
}

}  // namespace
}  // namespace fathom::test
