#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "codec/registry.hpp"
#include "geo/so3.hpp"
#include "sim/device_encoder.hpp"
#include "sim/encode/micromodem.hpp"
#include "sim/simulation.hpp"
#include "sim/truth_generator.hpp"
#include "support/codec/decode_run.hpp"
#include "vehicles.hpp"

namespace fathom::sim {
namespace {

TEST(RangeModel, DeviceBytesAreTheRangesOfTheBeaconsInTurn) {
  Scenario scenario = test::auv_scenario();
  auto& range = scenario.sensors.of<RangeSample>();
  range.enabled = true;
  range.protocol = "micromodem";
  range.rate_hz = 2.0;
  range.minimum_depth_m = -10.0;
  range.sound_speed_m_s = 1470.0;
  range.sigma_m = 0.2;
  range.beacons = {{"12", {300.0, 400.0, 20.0}}, {"13", {-600.0, 0.0, 30.0}}};
  Simulation simulation(scenario, {});
  DeviceEncoder encoder(scenario, 0);
  std::vector<Measurement> all;
  while (simulation.time_s() < 10.0) simulation.advance(all);
  codec::CodecOptions options;
  options.beacons.sound_speed_m_s = 1470.0;
  std::set<std::string> heard;
  int count = 0;
  for (const Measurement& one : all) {
    const auto* sent = std::get_if<RangeSample>(&one);
    if (sent == nullptr) continue;
    const auto run = test::decode_whole("micromodem", encoder.encode(one), options);
    ASSERT_EQ(run.samples.size(), 1U);
    const auto& read = std::get<RangeSample>(run.samples[0].sample);
    EXPECT_EQ(read.beacon, sent->beacon);
    EXPECT_NEAR(read.range_m, sent->range_m, 0.08);  // the device tells 0.1 ms
    const double expected_m = read.beacon == Name("12") ? 500.0 : 600.0;
    EXPECT_NEAR(sent->range_m, expected_m, 30.0);  // the vehicle stays near its start
    heard.insert(read.beacon.str());
    ++count;
  }
  EXPECT_EQ(heard, (std::set<std::string>{"12", "13"}));
  EXPECT_GE(count, 19);
}

TEST(RangeModel, BeaconsLieWhereTheSeedHasThemAndAreSaidToLieWhereTheScenarioHasThem) {
  const Scenario scenario = test::auv_scenario();
  RangeConfig config;
  config.sigma_m = 0.0;
  config.place_sigma_m = 2.0;
  config.beacons = {{"12", {300.0, 0.0, 20.0}}};
  TruthPoint point;
  point.latitude_rad = scenario.start.latitude_rad;
  point.longitude_rad = scenario.start.longitude_rad;
  point.altitude_m = scenario.environment.surface_altitude_m - 20.0;
  point.depth_m = 20.0;
  double squares_m2 = 0.0;
  constexpr int kSeeds = 200;
  for (int seed = 0; seed < kSeeds; ++seed) {
    RangeModel model(config, scenario, static_cast<std::uint64_t>(seed));
    const RangeSample first = model.sample(point);
    EXPECT_EQ(first.range_m, model.sample(point).range_m);
    const geo::Geodetic said{first.beacon_latitude_rad, first.beacon_longitude_rad, point.altitude_m};
    const geo::Geodetic start{point.latitude_rad, point.longitude_rad, point.altitude_m};
    EXPECT_NEAR(geo::difference_N(said, start).norm(), 300.0, 1e-3);
    squares_m2 += (first.range_m - 300.0) * (first.range_m - 300.0) / kSeeds;
  }
  EXPECT_NEAR(std::sqrt(squares_m2), 2.0, 0.4);
}

TEST(RangeModel, HasNoAnswerOutOfTheWaterAndOutOfEarshot) {
  const Scenario scenario = test::auv_scenario();
  RangeConfig config;
  config.maximum_range_m = 100.0;
  config.beacons = {{"12", {0.0, 0.0, 50.0}}};
  RangeModel model(config, scenario, 1);
  TruthPoint point;
  point.latitude_rad = scenario.start.latitude_rad;
  point.longitude_rad = scenario.start.longitude_rad;
  point.altitude_m = scenario.environment.surface_altitude_m - 10.0;
  point.depth_m = 10.0;
  const auto near = model.sample(point);
  EXPECT_NEAR(near.range_m, 40.0, 5.0 * config.sigma_m);
  EXPECT_NEAR(model.latency_s(), 40.0 / config.sound_speed_m_s, 1e-9);
  point.depth_m = 0.0;
  EXPECT_TRUE(std::isnan(model.sample(point).range_m));
  point.depth_m = 10.0;
  point.altitude_m = scenario.environment.surface_altitude_m - 500.0;
  const RangeSample silence = model.sample(point);
  EXPECT_TRUE(std::isnan(silence.travel_time_s));
  // The device says that it asked.
  const std::string text = encode::micromodem(silence);
  EXPECT_EQ(text.substr(0, 13), "$CAMPR,12,1,*");
  const auto run = test::decode_whole("micromodem", std::vector<std::uint8_t>(text.begin(), text.end()), {});
  EXPECT_TRUE(run.samples.empty());
  EXPECT_TRUE(run.rejected.empty());
}

}  // namespace
}  // namespace fathom::sim
