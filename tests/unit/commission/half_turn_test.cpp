#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "commission/dvl_check.hpp"
#include "sim/random.hpp"
#include "unit/commission/vehicle.hpp"

namespace fathom::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The vehicle heaves, rolls and pitches: its log tells the mounting, from wherever the search of it begins.
// It is so short that of a search that is cut off half-way the ratio of likelihoods would not tell.
sim::Scenario short_dive() {
  sim::Scenario out = commissioning_vehicle();
  constexpr double kRest_s = 60.0, kLeg_s = 12.0, kEnd_s = 190.0;
  out.mission.resize(1);
  double heading_deg = 60.0;
  for (int i = 0; kRest_s + i * kLeg_s < kEnd_s; ++i) {
    sim::MissionStep leg;
    leg.at_s = kRest_s + i * kLeg_s;
    heading_deg += i % 3 != 0 ? 90.0 : -110.0;
    leg.heading_rad = heading_deg * kRadPerDeg;
    leg.speed_m_s = i % 2 != 0 ? 2.4 : 1.1;
    leg.depth_m = i < 3 ? 0.0 : 4.0 + 8.0 * (i / 2 % 2);
    out.mission.push_back(leg);
  }
  out.duration_s = kEnd_s;
  return out;
}

TEST(CommissionHalfTurn, IsNoRivalWhereItsSearchComesBackToTheMountingThatTheLogTells) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    sim::Random random(seed, "half a turn off");
    const auto tilt_deg = [&] { return random.uniform(-4.0, 4.0); };
    const Matrix3d C_BD =
        geo::to_matrix(geo::from_rpy(Vector3d(tilt_deg(), tilt_deg(), 180.0 + tilt_deg()) * kRadPerDeg));
    dataset::Dataset data = drive(short_dive(), seed);
    dvl_through(data, C_BD.transpose());
    commission::Assumed assumed;
    assumed.gps.configured = assumed.dvl.configured = true;
    for (int run = 0; run < 2; ++run) {
      const auto found = commission::commission(data, assumed);
      if (run == 0) {
        ASSERT_TRUE(found.patch.C_BD.has_value()) << "seed " << seed << "\n" << wrongs(found.findings);
        assumed.dvl.C_BD = *found.patch.C_BD;
      } else {
        EXPECT_EQ(wrongs(found.findings), "") << "seed " << seed;
      }
      const Vector3d off_D = geo::log(geo::from_matrix(C_BD.transpose() * assumed.dvl.C_BD)) / kRadPerDeg;
      EXPECT_LT(off_D.norm(), 3.0) << "seed " << seed << " run " << run << " " << off_D.transpose();
    }
  }
}

}  // namespace
}  // namespace fathom::test
