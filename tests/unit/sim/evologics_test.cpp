// A USBL head on the vehicle: from the simulated fix over the device's line back to a fix.
#include <cmath>

#include <gtest/gtest.h>

#include "codec/registry.hpp"
#include "geo/so3.hpp"
#include "sim/device_encoder.hpp"
#include "sim/simulation.hpp"
#include "sim/truth_generator.hpp"
#include "support/codec/decode_run.hpp"
#include "vehicles.hpp"

namespace fathom::sim {
namespace {

Scenario with_modem(UsblConfig::Output output) {
  Scenario scenario = test::auv_scenario();
  auto& usbl = scenario.sensors.of<UsblSample>();
  usbl.enabled = true;
  usbl.protocol = "evologics";
  usbl.output = output;
  usbl.transponder = "7";
  usbl.rate_hz = 2.0;
  usbl.latency_s = 0.3;
  usbl.maximum_latency_s = 1.2;
  usbl.minimum_depth_m = -10.0;
  usbl.ship_N_m = {120.0, -80.0, 30.0};
  usbl.range_fraction = usbl.floor_m = usbl.angle_sigma_rad = usbl.outlier_probability = 0.0;
  return scenario;
}

/// Every fix that the simulated device has sent, and what its bytes say.
template <class Check>
int each_fix(UsblConfig::Output output, const codec::CodecOptions& options, const Check& check) {
  const Scenario scenario = with_modem(output);
  Simulation simulation(scenario, {});
  DeviceEncoder encoder(scenario, -3'600 * kNsPerSecond);
  std::vector<Measurement> all;
  int count = 0;
  while (simulation.time_s() < 10.0) {
    all.clear();
    simulation.advance(all);
    for (const Measurement& one : all) {
      const auto* sent = std::get_if<UsblSample>(&one);
      if (sent == nullptr) continue;
      const auto run = test::decode_whole("evologics", encoder.encode(one), options);
      if (run.samples.size() != 1) {
        ADD_FAILURE() << run.transcript;
        return count;
      }
      const codec::Decoded& decoded = run.samples[0];
      check(*sent, std::get<UsblSample>(decoded.sample));
      EXPECT_EQ(decoded.time.age_ns.has_value(), true);
      const DurationNs age = sent->header.received_ns - sent->header.stamp_ns;
      EXPECT_NEAR(to_seconds(decoded.time.age_ns.value_or(0)), to_seconds(age), 2e-6);
      ++count;
    }
  }
  return count;
}

TEST(Evologics, AHeadOnTheVehicleSaysWhereTheBeaconIsAlongTheVehicle) {
  codec::CodecOptions options;
  options.usbl.carrier = codec::UsblCarrier::vehicle;
  options.beacons.list[0] = {"7", 0.6, 0.2, 30.0};
  options.beacons.count = 1;
  const int count =
      each_fix(UsblConfig::Output::inverted, options, [](const UsblSample& sent, const UsblSample& read) {
        EXPECT_EQ(read.frame, UsblFrame::vehicle_frd);
        EXPECT_EQ(read.transponder.view(), "7");
        const double level_m = sent.range_m * std::cos(sent.depression_rad);
        EXPECT_NEAR(read.relative_m[0], level_m * std::cos(sent.bearing_rad), 1e-4);
        EXPECT_NEAR(read.relative_m[1], level_m * std::sin(sent.bearing_rad), 1e-4);
        EXPECT_NEAR(read.relative_m[2], sent.range_m * std::sin(sent.depression_rad), 1e-4);
        EXPECT_EQ(read.station_latitude_rad, 0.6);
        EXPECT_EQ(read.station_depth_m, 30.0);
      });
  EXPECT_GE(count, 15);
}

TEST(Evologics, AHeadOnAStationSaysWhereTheVehicleIs) {
  const int count = each_fix(UsblConfig::Output::ned, {}, [](const UsblSample& sent, const UsblSample& read) {
    EXPECT_EQ(read.frame, UsblFrame::ned);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(read.relative_m[i], sent.relative_m[i], 1e-4);
    EXPECT_NEAR(read.travel_time_s, sent.travel_time_s, 1e-6);
  });
  EXPECT_GE(count, 15);
}

}  // namespace
}  // namespace fathom::sim
