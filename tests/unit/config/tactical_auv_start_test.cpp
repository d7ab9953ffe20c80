// A shipped class with nothing set: an AUV at 2 m/s without a compass finds its heading under way, as well as
// it says.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "config/fusion/fusion_config.hpp"
#include "config/registry.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "sim/random.hpp"
#include "sim/simulation.hpp"

namespace fathom::config {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr int kSeeds = 48;
// Of a chi square of kSeeds degrees of freedom, 0.05 % of either side: the errors at one instant of all
// seeds.
constexpr double kLeastSum = 21.9;
constexpr double kMostSum = 87.0;

/// Straights and turns at the surface. The instruments are as bad as their sheets allow, drawn by the seed.
sim::Scenario scenario(sim::Random& random) {
  sim::Scenario out;
  out.vehicle.kind = sim::VehicleConfig::Kind::auv;
  out.start.latitude_rad = 36.4 * kDeg;
  out.start.longitude_rad = 127.4 * kDeg;
  out.start.depth_m = 0.1;
  out.environment.surface_altitude_m = 18.5;
  out.environment.water_depth_m = 45.0;
  double heading = random.uniform(0.0, 360.0);
  for (double t = 0.0; t < 80.0; t += 10.0) {
    sim::MissionStep one;
    one.at_s = t;
    one.speed_m_s = 2.0;
    one.heading_rad = std::remainder(heading, 360.0) * kDeg;
    out.mission.push_back(one);
    heading += random.uniform(-70.0, 70.0);
  }
  out.duration_s = 60.0;
  auto& imu = out.sensors.of<ImuSample>();
  imu.enabled = true;
  imu.rate_hz = 100.0;
  imu.gyro.bias_sigma = 1.0 * kDeg / 3600.0;
  imu.gyro.random_walk = 0.012 * kDeg / 60.0;
  imu.accelerometer.bias_sigma = 0.01;
  imu.accelerometer.random_walk = 0.07 / 60.0;
  auto& gps = out.sensors.of<GpsSample>();
  gps.enabled = true;
  gps.rate_hz = 2.0;
  gps.velocity_sigma_m_s = 0.1;
  gps.velocity_down_sigma_m_s = 0.2;
  gps.antenna_clearance_m = -1.0;  // it sits where the inertial unit is
  auto& dvl = out.sensors.of<DvlSample>();
  dvl.enabled = true;
  dvl.rate_hz = 5.0;
  dvl.beam_sigma_m_s = 0.01;
  dvl.scale_sigma = 0.003;
  dvl.misalignment_sigma_rad = 0.5 * kDeg;
  auto& depth = out.sensors.of<DepthSample>();
  depth.enabled = true;
  depth.rate_hz = 10.0;
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
  const sim::Scenario drawn = scenario(random);
  sim::Simulation::Options options;
  options.epoch_ns = 1'700'000'000 * kNsPerSecond;
  options.seed = seed;
  sim::Simulation simulation(drawn, options);
  estimation::FusionEngine engine(config);
  Found out;
  std::vector<sim::Measurement> measurements;
  for (int i = 0; i < static_cast<int>(drawn.duration_s * 100.0); ++i) {
    measurements.clear();
    simulation.advance(measurements);
    for (auto& measurement : measurements) {
      std::visit(
          [&](auto& sample) {
            using Sample = std::decay_t<decltype(sample)>;
            if constexpr (std::is_same_v<Sample, GpsSample>) sample.header.sensor = "gps";
            if constexpr (std::is_same_v<Sample, DepthSample>) sample.header.sensor = "depth";
            if constexpr (std::is_same_v<Sample, DvlSample>) sample.header.sensor = "dvl";
            if constexpr (requires { engine.add(sample); }) engine.add(sample);
          },
          measurement);
    }
    const NavState& nav = engine.nav_state();
    if (nav.alignment != AlignmentPhase::aligned) continue;
    const double error =
        std::remainder(nav.rpy_rad[2] - simulation.truth().rpy_rad[2], 2.0 * std::numbers::pi);
    out.last = std::pow(error / nav.rpy_sigma_rad[2], 2);
    out.last_sigma_deg = nav.rpy_sigma_rad[2] / kDeg;
    if (out.first) continue;
    out.first = out.last;
    out.aligned_at_s = 0.01 * i;
  }
  return out;
}

TEST(TacticalAuv, AlignsUnderWayWithoutACompassAndIsHonestAboutItsHeading) {
  const std::string file = std::string(FATHOM_SOURCE_DIR) + "/deploy/config/solve/tactical_auv.json";
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
