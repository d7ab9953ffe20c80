#include "sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "codec/registry.hpp"
#include "sim/device_encoder.hpp"
#include "support/codec/decode_run.hpp"
#include "vehicles.hpp"

namespace fathom::sim {
namespace {

constexpr TimeNs kEpoch = 1'700'000'000 * kNsPerSecond;

Scenario instrumented() {
  Scenario out = test::auv_scenario();
  auto& s = out.sensors;
  const auto use = [](SensorCommon& sensor, const char* protocol, double rate_hz, double latency_s) {
    sensor.enabled = true;
    sensor.protocol = protocol;
    sensor.rate_hz = rate_hz;
    sensor.latency_s = latency_s;
    sensor.jitter_s = 0.005;
  };
  use(s.of<ImuSample>(), "vectornav", 100.0, 0.002);
  use(s.of<GpsSample>(), "nmea0183", 2.0, 0.1);
  use(s.of<DvlSample>(), "pd0", 5.0, 0.15);
  use(s.of<DepthSample>(), "paroscientific", 10.0, 0.03);
  use(s.of<HeadingSample>(), "nmea0183", 10.0, 0.04);
  use(s.of<UsblSample>(), "psimssb", 0.2, 0.6);
  use(s.of<PropulsionSample>(), "nmea0183", 5.0, 0.02);
  use(s.of<FinsSample>(), "nmea0183", 5.0, 0.02);
  use(s.of<AirspeedSample>(), "ascii_air_data", 5.0, 0.02);
  s.of<GpsSample>().lever_B_m = {0.0, 0.0, -0.4};
  s.of<UsblSample>().minimum_depth_m = -1.0;
  s.of<ImuSample>().gyro.random_walk = 3e-5;
  s.of<ImuSample>().accelerometer.random_walk = 5e-4;
  return out;
}

struct Outcome {
  std::vector<Measurement> measurements;
  std::vector<std::uint8_t> bytes;
  std::vector<Truth> truths;
};

Outcome play(const Scenario& scenario, std::uint64_t seed, double duration_s) {
  Simulation::Options options;
  options.epoch_ns = kEpoch;
  options.seed = seed;
  Simulation simulation(scenario, options);
  DeviceEncoder encoder(scenario, kEpoch);
  Outcome out;
  while (simulation.time_s() < duration_s - 1e-9) {
    const std::size_t first = out.measurements.size();
    simulation.advance(out.measurements);
    out.truths.push_back(simulation.truth());
    for (std::size_t i = first; i < out.measurements.size(); ++i) {
      const auto bytes = encoder.encode(out.measurements[i]);
      out.bytes.insert(out.bytes.end(), bytes.begin(), bytes.end());
    }
  }
  return out;
}

TEST(Simulation, TheSameSeedGivesTheSameBytes) {
  const Outcome a = play(instrumented(), 4, 60.0);
  const Outcome b = play(instrumented(), 4, 60.0);
  const Outcome c = play(instrumented(), 5, 60.0);
  EXPECT_GT(a.bytes.size(), 300'000U);
  EXPECT_EQ(a.bytes, b.bytes);
  EXPECT_NE(a.bytes, c.bytes);
}

TEST(Simulation, AnotherSensorLeavesTheNoiseOfTheOthersAlone) {
  Scenario without = instrumented();
  without.sensors.of<DvlSample>().enabled = false;
  const Outcome a = play(instrumented(), 4, 30.0);
  const Outcome b = play(without, 4, 30.0);
  const auto imu_of = [](const Outcome& r) {
    std::vector<double> out;
    for (const auto& m : r.measurements) {
      if (const auto* imu = std::get_if<ImuSample>(&m)) out.push_back(imu->angular_rate_B_rad_s[0]);
    }
    return out;
  };
  EXPECT_EQ(imu_of(a), imu_of(b));
}

TEST(Simulation, RatesStampsAndSequences) {
  const Outcome r = play(instrumented(), 1, 50.0);
  std::map<std::string, std::vector<SampleHeader>> by_sensor;
  for (const auto& m : r.measurements) by_sensor[header_of(m).sensor.str()].push_back(header_of(m));
  EXPECT_EQ(by_sensor["imu"].size(), 5000U);
  EXPECT_EQ(by_sensor["gps"].size(), 101U);  // at 0 and at 50 s as well
  EXPECT_EQ(by_sensor["dvl"].size(), 251U);
  EXPECT_EQ(by_sensor["depth"].size(), 501U);
  for (const auto& [name, headers] : by_sensor) {
    for (std::size_t i = 0; i < headers.size(); ++i) {
      EXPECT_EQ(headers[i].sequence, i) << name;
      EXPECT_GE(headers[i].received_ns, headers[i].stamp_ns) << name;
      if (i > 0) {
        EXPECT_GE(headers[i].received_ns, headers[i - 1].received_ns) << name;
      }
    }
  }
  const auto& imu = by_sensor["imu"];
  for (std::size_t i = 0; i < imu.size(); ++i) {
    EXPECT_EQ(imu[i].stamp_ns, kEpoch + static_cast<TimeNs>(i + 1) * 10'000'000);
  }
}

std::vector<DvlSample> decoded(const Outcome& outcome, const Scenario& scenario) {
  DeviceEncoder encoder(scenario, kEpoch);
  std::vector<std::uint8_t> bytes;
  for (const Measurement& one : outcome.measurements) {
    if (!std::holds_alternative<DvlSample>(one)) continue;
    const auto some = encoder.encode(one);
    bytes.insert(bytes.end(), some.begin(), some.end());
  }
  const test::DecodeRun run = test::decode_whole(scenario.sensors.of<DvlSample>().protocol, bytes);
  EXPECT_TRUE(run.rejected.empty());
  return run.all<DvlSample>();
}

void expect_both_layers(const char* protocol) {
  SCOPED_TRACE(protocol);
  Scenario scenario = instrumented();
  scenario.sensors.of<DvlSample>().protocol = protocol;
  scenario.environment.current_N_m_s = {0.3, -0.2};
  scenario.environment.current_from_s = 0.0;
  const auto alone = decoded(play(scenario, 3, 30.0), scenario);
  scenario.sensors.of<DvlSample>().water_layer = true;
  scenario.sensors.of<DvlSample>().bottom_lost = {{20.0, 25.0}};
  const auto samples = decoded(play(scenario, 3, 30.0), scenario);
  ASSERT_EQ(samples.size(), 2 * 151U);
  ASSERT_EQ(alone.size(), 151U);
  int lost = 0;
  for (std::size_t i = 0; i < samples.size(); i += 2) {
    const DvlSample& bottom = samples[i];
    const DvlSample& water = samples[i + 1];
    ASSERT_EQ(bottom.mode, DvlMode::bottom);
    ASSERT_EQ(water.mode, DvlMode::water);
    EXPECT_TRUE(std::isfinite(water.velocity_D_m_s[0])) << i;
    if (std::isnan(bottom.velocity_D_m_s[0])) {
      ++lost;
      continue;
    }
    // They differ by the current.
    const double apart = std::hypot(bottom.velocity_D_m_s[0] - water.velocity_D_m_s[0],
                                    bottom.velocity_D_m_s[1] - water.velocity_D_m_s[1]);
    EXPECT_NEAR(apart, std::hypot(0.3, 0.2), 0.06) << i;
    EXPECT_EQ(bottom.velocity_D_m_s, alone[i / 2].velocity_D_m_s) << "as without the layer";
  }
  EXPECT_EQ(lost, 25);
}

TEST(Simulation, APingMeasuresBottomAndWaterLayer) {
  expect_both_layers("pd0");
  expect_both_layers("pd6");
}

TEST(Simulation, AWaterTrackIsNoBottomTrack) {
  Scenario scenario = instrumented();
  scenario.sensors.of<DvlSample>().water_track = true;
  scenario.sensors.of<DvlSample>().maximum_range_m = 1.0;  // far from the bottom
  const auto samples = decoded(play(scenario, 3, 10.0), scenario);
  ASSERT_EQ(samples.size(), 2 * 51U);
  for (const DvlSample& one : samples) {
    EXPECT_EQ(std::isfinite(one.velocity_D_m_s[0]), one.mode == DvlMode::water);
  }
}

TEST(Simulation, GpsOnlyAtTheSurface) {
  const Outcome r = play(instrumented(), 1, 130.0);
  int fixes_deep = 0;
  int fixes_at_start = 0;
  int fixes_at_end = 0;
  int silent_deep = 0;
  for (const auto& m : r.measurements) {
    const auto* gps = std::get_if<GpsSample>(&m);
    if (gps == nullptr) continue;
    const double t_s = to_seconds(gps->header.stamp_ns - kEpoch);
    const bool fix = gps->fix != GpsFix::none;
    if (t_s < 35.0 && fix) ++fixes_at_start;
    if (t_s > 50.0 && t_s < 90.0) ++(fix ? fixes_deep : silent_deep);
    if (t_s > 120.0 && fix) ++fixes_at_end;
  }
  EXPECT_GT(fixes_at_start, 60);
  EXPECT_EQ(fixes_deep, 0);
  EXPECT_GT(silent_deep, 70);  // the receiver goes on talking
  EXPECT_GT(fixes_at_end, 10);
}

TEST(Simulation, ScheduledAndRandomDropouts) {
  Scenario scenario = instrumented();
  scenario.sensors.of<DepthSample>().dropouts = {{10.0, 20.0}};
  scenario.sensors.of<HeadingSample>().dropout_probability = 0.3;
  const Outcome r = play(scenario, 1, 40.0);
  int depth_inside = 0;
  int headings = 0;
  for (const auto& m : r.measurements) {
    const double t_s = to_seconds(header_of(m).stamp_ns - kEpoch);
    if (std::holds_alternative<DepthSample>(m) && t_s >= 10.0 && t_s < 20.0) ++depth_inside;
    if (std::holds_alternative<HeadingSample>(m)) ++headings;
  }
  EXPECT_EQ(depth_inside, 0);
  EXPECT_NEAR(headings, 280, 40);
}

struct Collected : codec::Sink {
  void on_sample(const codec::Decoded& decoded) override { samples.push_back(decoded); }
  void on_rejected(const codec::Rejected&) override { ++rejected; }
  std::vector<codec::Decoded> samples;
  int rejected = 0;
};

/// What the codec of a protocol reads of what the device says in it.
template <class Sample>
std::vector<codec::Decoded> said(const Sample& sample, std::string_view protocol) {
  const Scenario scenario = instrumented();
  SimulatedDevice<Sample> device;
  const auto codec = codec::find_protocol(protocol)->make({});
  Collected sink;
  codec->feed(device.encode(sample, {protocol, scenario, kEpoch}), sink);
  codec->finish(sink);
  return sink.samples;
}

TEST(DeviceEncoder, TheCodecsReadWhatTheDevicesSay) {
  const Scenario scenario = instrumented();
  Simulation::Options options;
  options.epoch_ns = kEpoch;
  Simulation simulation(scenario, options);
  DeviceEncoder encoder(scenario, kEpoch - 5 * kNsPerSecond);
  std::map<std::string, std::vector<std::uint8_t>> streams;
  std::map<std::string, std::size_t> sent;
  std::vector<Measurement> all;
  while (simulation.time_s() < 30.0) simulation.advance(all);
  for (const auto& m : all) {
    const auto name = header_of(m).sensor.str();
    const auto bytes = encoder.encode(m);
    ASSERT_FALSE(bytes.empty()) << name;
    streams[name].insert(streams[name].end(), bytes.begin(), bytes.end());
    ++sent[name];
  }
  EXPECT_EQ(streams.size(), 9U);
  for (const auto& [name, bytes] : streams) {
    codec::CodecOptions codec_options;
    codec_options.latitude_rad = scenario.start.latitude_rad;
    const auto* protocol = codec::find_protocol(find_sensor(scenario.sensors, name)->protocol);
    ASSERT_NE(protocol, nullptr);
    const auto codec = protocol->make(codec_options);
    Collected sink;
    codec->feed(bytes, sink);
    codec->finish(sink);
    EXPECT_EQ(sink.rejected, 0) << name;
    EXPECT_EQ(sink.samples.size(), sent[name]) << name;
    EXPECT_EQ(codec->totals().skipped_bytes, 0U) << name;
  }
  // Times of validity are in the device's own clock fields.
  const auto codec = codec::find_protocol("vectornav")->make({});
  Collected sink;
  codec->feed(streams["imu"], sink);
  ASSERT_GE(sink.samples.size(), 100U);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(sink.samples[i].time.clock_ns.value(),
              5 * kNsPerSecond + static_cast<TimeNs>(i + 1) * 10'000'000);
  }
}

TEST(DeviceEncoder, AnInertialUnitSaysTheSameInEveryProtocol) {
  Scenario scenario = test::auv_scenario();
  auto& imu = scenario.sensors.of<ImuSample>();
  imu.enabled = true;
  imu.rate_hz = 100.0;
  for (const std::string_view protocol : SimulatedDevice<ImuSample>::kProtocols) {
    SCOPED_TRACE(protocol);
    imu.protocol = protocol;
    Simulation::Options options;
    options.epoch_ns = kEpoch;
    Simulation simulation(scenario, options);
    DeviceEncoder encoder(scenario, kEpoch - 5 * kNsPerSecond);
    std::vector<Measurement> all;
    while (simulation.time_s() < 1.0) simulation.advance(all);
    const auto codec = codec::find_protocol(protocol)->make({});
    Collected sink;
    std::vector<ImuSample> sent;
    for (const auto& m : all) {
      if (!std::holds_alternative<ImuSample>(m)) continue;
      sent.push_back(std::get<ImuSample>(m));
      codec->feed(encoder.encode(m), sink);
    }
    EXPECT_EQ(sink.rejected, 0);
    ASSERT_EQ(sink.samples.size(), sent.size());
    ASSERT_GT(sent.size(), 90U);
    for (std::size_t k = 0; k < sent.size(); ++k) {
      const auto& got = std::get<ImuSample>(sink.samples[k].sample);
      EXPECT_NEAR(got.specific_force_B_m_s2[2], sent[k].specific_force_B_m_s2[2], 1e-5) << k;
      EXPECT_NEAR(got.angular_rate_B_rad_s[1], sent[k].angular_rate_B_rad_s[1], 1e-6) << k;
      if (k == 0) continue;  // the interval before is not in every message
      const bool increments =
          protocol != "stim300" && protocol != "sbg" && protocol != "kvh";  // as they are set here
      EXPECT_EQ(known(got.delta_time_s), increments) << k;
      if (!increments) continue;
      EXPECT_NEAR(got.delta_time_s, sent[k].delta_time_s, 1e-6) << k;
      EXPECT_NEAR(got.delta_velocity_B_m_s[2], sent[k].delta_velocity_B_m_s[2], 1e-7) << k;
    }
  }
}

TEST(DeviceEncoder, AnInertialUnitIsUnderstoodInEachOfItsProtocols) {
  ImuSample imu;
  imu.header.stamp_ns = kEpoch + kNsPerSecond;
  imu.angular_rate_B_rad_s = {0.1, -0.2, 0.3};
  imu.specific_force_B_m_s2 = {1.0, -2.0, -9.8};
  for (const std::string_view protocol : SimulatedDevice<ImuSample>::kProtocols) {
    const auto decoded = said(imu, protocol);
    ASSERT_EQ(decoded.size(), 1U) << protocol;
    const auto& read = std::get<ImuSample>(decoded[0].sample);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(read.angular_rate_B_rad_s[i], imu.angular_rate_B_rad_s[i], 1e-6) << protocol;
      EXPECT_NEAR(read.specific_force_B_m_s2[i], imu.specific_force_B_m_s2[i], 1e-4) << protocol;
    }
  }
}

TEST(DeviceEncoder, ASatelliteReceiverIsUnderstoodInEachOfItsProtocols) {
  GpsSample gps;
  gps.header.stamp_ns = kEpoch + kNsPerSecond;
  gps.fix = GpsFix::fix_3d;
  gps.satellites = 11;
  gps.latitude_rad = 0.635;
  gps.longitude_rad = -2.223;
  gps.altitude_m = 18.5;
  gps.altitude_msl_m = -7.0;
  gps.position_sigma_N_m = {0.5, 0.5, 0.8};
  gps.velocity_N_m_s = {1.5, -0.5, 0.0};
  gps.velocity_sigma_N_m_s.fill(0.05);
  gps.hdop = 0.9;
  for (const std::string_view protocol : SimulatedDevice<GpsSample>::kProtocols) {
    const auto decoded = said(gps, protocol);
    ASSERT_EQ(decoded.size(), 1U) << protocol;
    EXPECT_EQ(decoded[0].time.utc_ns, gps.header.stamp_ns) << protocol;
    const auto& read = std::get<GpsSample>(decoded[0].sample);
    EXPECT_EQ(read.fix, gps.fix) << protocol;
    EXPECT_NEAR(read.latitude_rad, gps.latitude_rad, 1e-9) << protocol;
    EXPECT_NEAR(read.longitude_rad, gps.longitude_rad, 1e-9) << protocol;
    EXPECT_NEAR(read.velocity_N_m_s[0], gps.velocity_N_m_s[0], 0.01) << protocol;
  }
}

TEST(DeviceEncoder, KnowsWhatItCanSay) {
  EXPECT_TRUE(can_encode("gps", "nmea"));
  EXPECT_TRUE(can_encode("gps", "u-blox"));
  EXPECT_TRUE(can_encode("dvl", "teledyne_pd0"));
  EXPECT_TRUE(can_encode("dvl", "teledyne_pd6"));
  EXPECT_TRUE(can_encode("airspeed", "openvario"));
  EXPECT_FALSE(can_encode("dvl", "nmea0183"));
  EXPECT_FALSE(can_encode("imu", "no_such_protocol"));
  EXPECT_EQ(find_sensor(SensorSuite{}, "sonar"), nullptr);
}

TEST(DeviceEncoder, ACompassIsUnderstoodInEachOfItsProtocols) {
  HeadingSample heading;
  heading.header.stamp_ns = kEpoch + kNsPerSecond;
  heading.heading_rad = 5.5;
  for (const std::string_view protocol : SimulatedDevice<HeadingSample>::kProtocols) {
    const auto decoded = said(heading, protocol);
    ASSERT_EQ(decoded.size(), 1U) << protocol;
    const auto& read = std::get<HeadingSample>(decoded[0].sample);
    EXPECT_EQ(read.north, North::true_north) << protocol;
    EXPECT_NEAR(read.heading_rad, heading.heading_rad, 1e-5) << protocol;
  }
}

TEST(DeviceEncoder, SpeaksOnlyProtocolsThatTheRegistryDecodes) {
  for_each_kind([](auto kind) {
    for (const std::string_view protocol : SimulatedDevice<typename decltype(kind)::Sample>::kProtocols) {
      const codec::Protocol* known = codec::find_protocol(protocol);
      ASSERT_NE(known, nullptr) << kind.kWord << ": " << protocol;
      EXPECT_EQ(known->name, protocol) << kind.kWord;
      EXPECT_TRUE(can_encode(kind.kSource, protocol));
    }
    EXPECT_FALSE(can_encode(kind.kSource, "morse")) << kind.kWord;
  });
  EXPECT_FALSE(can_encode(SourceKind::imu, "pd0"));
}

}  // namespace
}  // namespace fathom::sim
