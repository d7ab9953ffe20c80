// A shipped class with nothing set: an AUV at 2 m/s without a compass finds its heading under way, as well as
// it says.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "config/fusion/fusion_config.hpp"
#include "config/registry.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "sim/random.hpp"
#include "sim/simulation.hpp"
#include "support/paths.hpp"
#include "support/vehicles/simulated_drive.hpp"

namespace fathom::config {
namespace {

constexpr int kSeeds = 48;
// Of a chi square of kSeeds degrees of freedom, 0.05 % of either side: the errors at one instant of all
// seeds.
constexpr double kLeastSum = 21.9;
constexpr double kMostSum = 87.0;

/// Straights and turns at the surface. The instruments are as bad as their sheets allow, drawn by the seed.
sim::Scenario scenario(sim::Random& random) {
  sim::Scenario out = test::auv_at(36.4 * kRadPerDeg, 127.4 * kRadPerDeg);
  out.environment.surface_altitude_m = 18.5;
  out.environment.water_depth_m = 45.0;
  double heading = random.uniform(0.0, 360.0);
  for (double t = 0.0; t < 80.0; t += 10.0) {
    sim::MissionStep one;
    one.at_s = t;
    one.speed_m_s = 2.0;
    one.heading_rad = std::remainder(heading, 360.0) * kRadPerDeg;
    out.mission.push_back(one);
    heading += random.uniform(-70.0, 70.0);
  }
  auto& imu = test::enable<ImuSample>(out, 100.0);
  imu.gyro.bias_sigma = 1.0 * kRadPerDeg / 3600.0;
  imu.gyro.random_walk = 0.012 * kRadPerDeg / 60.0;
  imu.accelerometer.bias_sigma = 0.01;
  imu.accelerometer.random_walk = 0.07 / 60.0;
  auto& gps = test::enable<GpsSample>(out, 2.0);
  gps.velocity_sigma_m_s = 0.1;
  gps.velocity_down_sigma_m_s = 0.2;
  gps.antenna_clearance_m = -1.0;  // it sits where the inertial unit is
  auto& dvl = test::enable<DvlSample>(out, 5.0);
  dvl.beam_sigma_m_s = 0.01;
  dvl.scale_sigma = 0.003;
  dvl.misalignment_sigma_rad = 0.5 * kRadPerDeg;
  test::enable<DepthSample>(out, 10.0);
  return out;
}

struct Found {
  double aligned_at_s = kUnknown;
  std::optional<double> first;  ///< NEES of the heading when it is aligned
  std::optional<double> last;   ///< and at the end
  double last_sigma_deg = kUnknown;
};

Found run(const estimation::EngineConfig& config, std::uint64_t seed) {
  sim::Random random(seed, "as the sheet says");
  estimation::FusionEngine engine(config);
  Found out;
  test::drive(
      engine, scenario(random), seed, [](auto&) {},
      [&](int i, const auto& truth) {
        const NavState& nav = engine.nav_state();
        if (nav.alignment != AlignmentPhase::aligned) return;
        const double error = std::remainder(nav.rpy_rad[2] - truth.rpy_rad[2], 2.0 * std::numbers::pi);
        out.last = std::pow(error / nav.rpy_sigma_rad[2], 2);
        out.last_sigma_deg = nav.rpy_sigma_rad[2] / kRadPerDeg;
        if (out.first) return;
        out.first = out.last;
        out.aligned_at_s = 0.01 * i;
      });
  return out;
}

TEST(TacticalAuv, AlignsUnderWayWithoutACompassAndIsHonestAboutItsHeading) {
  const std::string file = test::source_dir() + "/deploy/config/solve/tactical_auv.json";
  const estimation::EngineConfig config = engine_config(load_service_config<FusionConfig>({file, {}}).value);
  double first = 0.0;
  double last = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Found found = run(config, seed);
    ASSERT_TRUE(found.first) << "seed " << seed;
    EXPECT_LT(found.aligned_at_s, 45.0) << "seed " << seed;
    first += *found.first;
    last += *found.last;
  }
  EXPECT_LT(first, kMostSum);
  EXPECT_GT(first, kLeastSum);
  EXPECT_LT(last, kMostSum);
  EXPECT_GT(last, kLeastSum);
}

}  // namespace
}  // namespace fathom::config
