#include "unit/commission/level_boat.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace fathom::test
