#include <cmath>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "codec/registry.hpp"
#include "sim/device_encoder.hpp"
#include "sim/simulation.hpp"
#include "sim/truth_generator.hpp"
#include "sim/vehicles/vehicle.hpp"
#include "support/codec/decode_run.hpp"
#include "vehicles.hpp"

namespace fathom::sim {
namespace {

TruthPoint at_depth(double depth_m) {
  TruthPoint out;
  out.t_s = 1.0;
  out.depth_m = depth_m;
  out.water_depth_m = 40.0;
  return out;
}

AltimeterConfig perfect() {
  AltimeterConfig config;
  config.sigma_m = 0.0;
  return config;
}

TEST(AltimeterModel, IsTheWayToTheBottomAlongItsAxisFromItsPlace) {
  AltimeterConfig config = perfect();
  EXPECT_DOUBLE_EQ(AltimeterModel(config, 1).sample(at_depth(10.0)).altitude_m, 30.0);
  TruthPoint tilted = at_depth(10.0);
  tilted.q_NB = q_of_rpy(0.0, 60.0 * kRadPerDeg, 0.3);
  EXPECT_NEAR(AltimeterModel(config, 1).sample(tilted).altitude_m, 60.0, 1e-9);
  config.lever_B_m = {1.0, 0.0, 0.2};  // nose up: the altimeter ahead of the origin is higher by sin 60
  tilted.q_NB = q_of_rpy(0.0, 60.0 * kRadPerDeg, 0.0);
  const double lower_m = 0.2 * std::cos(60.0 * kRadPerDeg) - std::sin(60.0 * kRadPerDeg);
  EXPECT_NEAR(AltimeterModel(config, 1).sample(tilted).altitude_m, 2.0 * (30.0 - lower_m), 1e-6);
}

TEST(AltimeterModel, SaysThatItHearsNothing) {
  AltimeterConfig config = perfect();
  config.minimum_range_m = 1.0;
  config.maximum_range_m = 25.0;
  config.dropouts = {{5.0, 6.0}};
  AltimeterModel model(config, 1);
  EXPECT_TRUE(known(model.sample(at_depth(20.0)).altitude_m));
  EXPECT_FALSE(known(model.sample(at_depth(10.0)).altitude_m));  // too far
  EXPECT_FALSE(known(model.sample(at_depth(39.5)).altitude_m));  // too near
  EXPECT_FALSE(known(model.sample(at_depth(-1.0)).altitude_m));  // in the air
  TruthPoint silent = at_depth(20.0);
  silent.t_s = 5.5;
  EXPECT_FALSE(known(model.sample(silent).altitude_m));
}

TEST(AltimeterModel, ItsBytesSayWhatItMeasured) {
  Scenario scenario = test::auv_scenario();
  auto& altimeter = scenario.sensors.of<AltimeterSample>();
  altimeter.enabled = true;
  altimeter.protocol = "nmea0183";
  altimeter.rate_hz = 5.0;
  altimeter.dropouts = {{4.0, 6.0}};
  Simulation simulation(scenario, {});
  DeviceEncoder encoder(scenario, 0);
  std::vector<Measurement> all;
  while (simulation.time_s() < 10.0) simulation.advance(all);
  int heard = 0;
  int unheard = 0;
  for (const Measurement& one : all) {
    const auto* sent = std::get_if<AltimeterSample>(&one);
    if (sent == nullptr) continue;
    const auto run = test::decode_whole("nmea0183", encoder.encode(one));
    ASSERT_EQ(run.samples.size(), 1U);
    ASSERT_TRUE(run.rejected.empty());
    const auto& read = std::get<AltimeterSample>(run.samples[0].sample);
    ASSERT_EQ(known(read.altitude_m), known(sent->altitude_m));
    ++(known(read.altitude_m) ? heard : unheard);
    if (known(read.altitude_m)) {
      EXPECT_NEAR(read.altitude_m, sent->altitude_m, 0.0051);
      EXPECT_NEAR(read.altitude_m, 40.0, 1.0);  // afloat above the bottom of the scenario
    }
    EXPECT_EQ(read.transducer_offset_m, 0.0);
  }
  EXPECT_EQ(heard, 41);  // the first at the start
  EXPECT_EQ(unheard, 10);
}

}  // namespace
}  // namespace fathom::sim
