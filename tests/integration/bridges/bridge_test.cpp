// Each bridge as a process of its own: device bytes in, samples on the bus out.

#include <algorithm>
#include <csignal>
#include <memory>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/units.hpp"
#include "heading_by_tcp.hpp"
#include "samples/actuator.hpp"
#include "samples/airspeed.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/imu.hpp"
#include "samples/usbl.hpp"
#include "sim/encode/air_data.hpp"
#include "sim/encode/depth.hpp"
#include "sim/encode/dvl/pd0.hpp"
#include "sim/encode/imu/vectornav.hpp"
#include "sim/encode/nmea.hpp"
#include "support.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

namespace encode = sim::encode;

std::string serial(const std::string& path) {
  return R"(sensors.0.source={"type":"serial","path":")" + path + R"(","backoff_most_s":0.2,"silence_s":1})";
}

std::string udp(int port) {
  return R"(sensors.0.source={"type":"udp","address":"127.0.0.1","port":)" + std::to_string(port) + "}";
}

TEST(ImuBridge, RatesForcesStampsAndSequence) {
  constexpr int kDomain = 140;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<ImuSample> imu(participant);
  const SerialDevice device(folder / "imu");
  const Process bridge(
      "fathom-imu-bridge",
      bridge_arguments("imu", kDomain,
                       {serial(folder / "imu"), R"(sensors.0.mounting={"frame":"flu"})",
                        R"(sensors.0.time={"mode":"device_clock","minimum_latency_s":0.003})"}),
      folder / "log");
  ASSERT_TRUE(eventually([&] { return imu.matched(); })) << bridge.output();
  ImuSample sent;
  sent.angular_rate_B_rad_s = {0.125, -0.25, 0.5};
  sent.specific_force_B_m_s2 = {1.0, 2.0, 9.75};
  DurationNs clock = 1000 * kNsPerSecond;
  const TimeNs before = utc_now();
  ASSERT_TRUE(eventually([&] {
    device.send(encode::vectornav(sent, clock += 10 * kNsPerMillisecond));
    return imu.count() >= 50;
  })) << bridge.output();
  const TimeNs after = utc_now();
  const auto all = imu.all();
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].header.vehicle, "auv");
    EXPECT_EQ(all[i].header.sensor, "imu");
    EXPECT_GE(all[i].header.received_ns, before);
    EXPECT_LE(all[i].header.received_ns, after);
    EXPECT_LE(all[i].header.stamp_ns, all[i].header.received_ns - 3 * kNsPerMillisecond);
    EXPECT_EQ(all[i].angular_rate_B_rad_s, (std::array<double, 3>{0.125, 0.25, -0.5}));
    EXPECT_EQ(all[i].specific_force_B_m_s2, (std::array<double, 3>{1.0, -2.0, -9.75}));
    if (i == 0) continue;
    EXPECT_EQ(all[i].header.sequence, all[i - 1].header.sequence + 1);
    EXPECT_GE(all[i].header.stamp_ns, all[i - 1].header.stamp_ns);
  }
}

TEST(DvlBridge, AnInstrumentThatIsKilledAndReturns) {
  constexpr int kDomain = 141;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<DvlSample> dvl(participant);
  const Collector<ServiceStatus> status(participant);
  auto device = std::make_unique<TcpDevice>();
  const int port = device->port();
  const std::string source = R"(sensors.0.source={"type":"tcp_client","port":)" + std::to_string(port) +
                             R"(,"backoff_most_s":0.2,"silence_s":1})";
  const Process bridge("fathom-dvl-bridge", bridge_arguments("dvl", kDomain, {source, "sensors.0.rate_hz=5"}),
                       folder / "log");
  ASSERT_TRUE(eventually([&] { return dvl.matched() && status.matched(); })) << bridge.output();
  DvlSample sent;
  sent.velocity_D_m_s = {1.5, -0.25, 0.125};
  sent.error_velocity_m_s = 0.0;
  const auto talk = [&] { device->send(encode::pd0(sent, utc_now())); };
  ASSERT_TRUE(eventually([&] {
    talk();
    return dvl.count() > 10 && is_in_state(status, ServiceState::healthy);
  })) << bridge.output();
  EXPECT_NEAR(dvl.all().front().velocity_D_m_s[0], 1.5, 1e-3);
  EXPECT_NEAR(dvl.all().front().velocity_D_m_s[1], -0.25, 1e-3);
  EXPECT_NEAR(dvl.all().front().velocity_D_m_s[2], 0.125, 1e-3);
  EXPECT_EQ(dvl.all().front().mode, DvlMode::bottom);

  device.reset();
  ASSERT_TRUE(eventually([&] { return is_in_state(status, ServiceState::degraded, "Connection refused"); }))
      << bridge.output();
  const std::size_t before = dvl.count();
  device = std::make_unique<TcpDevice>(port);
  ASSERT_TRUE(eventually([&] {
    talk();
    return dvl.count() > before + 10 && is_in_state(status, ServiceState::healthy);
  })) << bridge.output();
  EXPECT_EQ(counter(status, "connects"), 2U);
}

TEST(GpsBridge, ADeadReceiverDoesNotDisturbTheLivingOne) {
  constexpr int kDomain = 142;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<GpsSample> gps(participant);
  const Collector<ServiceStatus> status(participant);
  const int port = free_port(SOCK_DGRAM);
  const std::string sensors =
      R"(sensors=[{"name":"dead","source":{"type":"serial","path":"/nonexistent/gps"},"protocol":"ubx",)"
      R"("time":{"mode":"device_utc"},"rate_hz":5},{"name":"living","source":{"type":"udp","port":)" +
      std::to_string(port) + R"(},"protocol":"nmea0183","time":{"mode":"device_utc"},"rate_hz":20}])";
  const Process bridge("fathom-gps-bridge", bridge_arguments("gps", kDomain, {sensors}), folder / "log");
  ASSERT_TRUE(eventually([&] { return gps.matched() && status.matched(); })) << bridge.output();
  GpsSample sent;
  sent.fix = GpsFix::fix_3d;
  sent.satellites = 9;
  sent.latitude_rad = 36.4 * kRadPerDeg;
  sent.longitude_rad = 127.4 * kRadPerDeg;
  sent.altitude_m = 43.5;
  sent.altitude_msl_m = 18.5;
  sent.velocity_N_m_s = {1.0, 0.5, kUnknown};
  TimeNs said = 0;
  ASSERT_TRUE(eventually([&] {
    said = utc_now() / (10 * kNsPerMillisecond) * (10 * kNsPerMillisecond);
    send_udp(port, bytes_of(encode::nmea_gps(sent, said)));
    return gps.count() > 20 && is_in_state(status, ServiceState::degraded, "dead: ");
  })) << bridge.output();
  const GpsSample got = gps.all().back();
  EXPECT_EQ(got.header.sensor, "living");
  EXPECT_NEAR(got.latitude_rad, sent.latitude_rad, 1e-8);
  EXPECT_NEAR(got.altitude_m, 43.5, 0.1);
  // The receiver's own time, to the 10 ms it was sent with.
  EXPECT_EQ(got.header.stamp_ns % (10 * kNsPerMillisecond), 0);
  EXPECT_LE(got.header.stamp_ns, got.header.received_ns);
  EXPECT_EQ(counter(status, "samples:dead"), 0U);
  EXPECT_GT(counter(status, "samples:living"), 0U);
  // The dead one was said once, not at each attempt.
  const std::string log = bridge.output();
  const std::string complaint = "/nonexistent/gps: No such file";
  ASSERT_NE(log.find(complaint), std::string::npos) << log;
  EXPECT_EQ(log.find(complaint), log.rfind(complaint)) << log;
}

TEST(DepthBridge, AFloodOfGarbageIsCountedAndSurvived) {
  constexpr int kDomain = 143;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<DepthSample> depth(participant);
  const Collector<ServiceStatus> status(participant);
  const SerialDevice device(folder / "depth");
  const Process bridge("fathom-depth-bridge",
                       bridge_arguments("depth", kDomain, {serial(folder / "depth"), "sensors.0.rate_hz=5"}),
                       folder / "log");
  ASSERT_TRUE(eventually([&] { return depth.matched() && status.matched(); })) << bridge.output();
  codec::CodecOptions options;
  options.pressure_unit_Pa = 6'894.757293168;
  options.latitude_rad = 36.4 * kRadPerDeg;
  DepthSample sent;
  sent.depth_m = 42.0;
  const auto talk = [&] { device.send(bytes_of(encode::paroscientific(sent, options))); };
  ASSERT_TRUE(eventually([&] {
    talk();
    return depth.count() > 20 && is_in_state(status, ServiceState::healthy);
  })) << bridge.output();
  const DepthSample last = depth.all().back();  // more may be on their way
  EXPECT_NEAR(last.depth_m, 42.0, 0.02);
  EXPECT_EQ(last.header.stamp_ns, last.header.received_ns - 50 * kNsPerMillisecond);

  std::uint32_t noise = 1;
  std::string garbage(1000, '\0');
  ASSERT_TRUE(eventually([&] {
    for (char& c : garbage) c = static_cast<char>((noise = noise * 1'664'525U + 1'013'904'223U) >> 24);
    device.send(bytes_of(garbage));
    return is_in_state(status, ServiceState::degraded, "garbage") &&
           bridge.output().find("no good frame of paroscientific among them; they begin ") !=
               std::string::npos;
  })) << bridge.output();
  EXPECT_NE(bridge.output().find("expected paroscientific at 115200 baud 8N1 from serial "),
            std::string::npos)
      << bridge.output();
  EXPECT_GT(counter(status, "rejected_length") + counter(status, "rejected_structure") +
                counter(status, "rejected_field") + counter(status, "skipped_bytes"),
            0U);
  const std::size_t before = depth.count();
  device.send(bytes_of("\r\n"));
  ASSERT_TRUE(eventually([&] {
    talk();
    return depth.count() > before + 20 && is_in_state(status, ServiceState::healthy);
  })) << bridge.output();
  EXPECT_NE(bridge.output().find(": understood now"), std::string::npos) << bridge.output();
  EXPECT_NEAR(depth.all().back().depth_m, 42.0, 0.02);
}

TEST(DepthBridge, SamplesReadAtOnceAfterAPauseAreStampedOnePeriodApart) {
  constexpr int kDomain = 143;
  constexpr DurationNs kPeriod = 200 * kNsPerMillisecond;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<DepthSample> depth(participant);
  const SerialDevice device(folder / "depth");
  const Process bridge("fathom-depth-bridge",
                       bridge_arguments("depth", kDomain, {serial(folder / "depth"), "sensors.0.rate_hz=5"}),
                       folder / "log");
  ASSERT_TRUE(eventually([&] { return depth.matched(); })) << bridge.output();
  codec::CodecOptions options;
  options.pressure_unit_Pa = 6'894.757293168;
  DepthSample sent;
  sent.depth_m = 42.0;
  const std::string frame = encode::paroscientific(sent, options);
  ASSERT_TRUE(eventually([&] {
    device.send(bytes_of(frame));
    return depth.count() > 0;
  })) << bridge.output();
  // The kernel may hand over two frames in two reads; not always.
  ASSERT_TRUE(eventually([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(450));
    device.send(bytes_of(frame + frame));
    const auto all = depth.all();
    for (std::size_t i = 1; i < all.size(); ++i) {
      const DurationNs apart = all[i].header.stamp_ns - all[i - 1].header.stamp_ns;
      EXPECT_GE(apart, 0);
      if (apart == kPeriod && all[i].header.received_ns == all[i - 1].header.received_ns) return true;
    }
    return false;
  })) << bridge.output();
}

TEST(HeadingBridge, TheInstrumentConnectsToTheBridge) {
  const HeadingByTcp run;
  ASSERT_TRUE(eventually([&] { return run.heading.matched(); })) << run.bridge.output();
  int device = -1;  // the bridge is on the network a little before it listens
  ASSERT_TRUE(eventually([&] { return (device = connect_to(run.port)) >= 0; })) << run.bridge.output();
  HeadingSample sent;
  sent.heading_rad = 271.3 * kRadPerDeg;
  const std::string sentence = encode::nmea_heading(sent);
  EXPECT_TRUE(eventually([&] {
    ::send(device, sentence.data(), sentence.size(), MSG_NOSIGNAL);
    return run.heading.count() > 3;
  })) << run.bridge.output();
  EXPECT_NEAR(run.heading.all().front().heading_rad, sent.heading_rad, 1e-3);
  EXPECT_EQ(run.heading.all().front().north, North::true_north);
  close(device);
}

TEST(UsblBridge, AFixThatIsTwoSecondsLateKeepsItsTime) {
  constexpr int kDomain = 145;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<UsblSample> usbl(participant);
  const int port = free_port(SOCK_DGRAM);
  const Process bridge("fathom-usbl-bridge", bridge_arguments("usbl", kDomain, {udp(port)}), folder / "log");
  ASSERT_TRUE(eventually([&] { return usbl.matched(); })) << bridge.output();
  UsblSample sent;
  sent.frame = UsblFrame::geodetic;
  sent.transponder = "B01";
  sent.latitude_rad = 36.401 * kRadPerDeg;
  sent.longitude_rad = 127.402 * kRadPerDeg;
  sent.depth_m = 30.0;
  sent.sigma_m = 2.0;
  const TimeNs valid = utc_now() / (10 * kNsPerMillisecond) * (10 * kNsPerMillisecond) - 2 * kNsPerSecond;
  ASSERT_TRUE(eventually([&] {
    send_udp(port, bytes_of(encode::psimssb(sent, valid)));
    return usbl.count() > 0;
  })) << bridge.output();
  const UsblSample got = usbl.all().front();
  EXPECT_NEAR(to_seconds(got.header.stamp_ns - valid), 0.0, 0.011);
  EXPECT_GT(got.header.received_ns - got.header.stamp_ns, 2 * kNsPerSecond);
  EXPECT_NEAR(got.latitude_rad, sent.latitude_rad, 1e-7);
  EXPECT_NEAR(got.depth_m, 30.0, 0.1);
}

TEST(ActuatorBridge, PropulsorAndFinsOfOneStreamOthersIgnored) {
  constexpr int kDomain = 146;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<PropulsionSample> propulsion(participant);
  const Collector<FinsSample> fins(participant);
  const Collector<ServiceStatus> status(participant);
  const int port = free_port(SOCK_DGRAM);
  const Process bridge("fathom-actuator-bridge",
                       bridge_arguments("actuator", kDomain, {udp(port), "sensors.0.max_rpm=2000"}),
                       folder / "log");
  ASSERT_TRUE(eventually([&] { return propulsion.matched() && fins.matched(); })) << bridge.output();
  PropulsionSample shaft;
  shaft.rpm = -600.0;
  PropulsionSample impossible;
  impossible.rpm = 9000.0;
  FinsSample fin;
  fin.rudder_rad = 5.0 * kRadPerDeg;
  fin.stern_rad = -3.0 * kRadPerDeg;
  HeadingSample heading;
  heading.heading_rad = 1.0;
  ASSERT_TRUE(eventually([&] {
    send_udp(port, bytes_of(encode::nmea_rpm(shaft) + encode::nmea_rpm(impossible) + encode::nmea_fins(fin) +
                            encode::nmea_heading(heading)));
    return propulsion.count() > 3 && fins.count() > 3 && counter(status, "ignored_kinds") > 0 &&
           counter(status, "refused_impossible") > 0;
  })) << bridge.output();
  EXPECT_NE(bridge.output().find("sample refused: rpm is 9000, expected -2000 to 2000"), std::string::npos)
      << bridge.output();
  for (const auto& each : propulsion.all()) EXPECT_NEAR(each.rpm, -600.0, 0.1);
  double rudder_rad = kUnknown;
  double stern_rad = kUnknown;
  for (const auto& each : fins.all()) {
    if (known(each.rudder_rad)) rudder_rad = each.rudder_rad;
    if (known(each.stern_rad)) stern_rad = each.stern_rad;
  }
  EXPECT_NEAR(rudder_rad, fin.rudder_rad, 0.002);
  EXPECT_NEAR(stern_rad, fin.stern_rad, 0.002);
}

TEST(AirDataBridge, ColumnsBecomeTrueAirspeedAndDamageIsCounted) {
  constexpr int kDomain = 149;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<AirspeedSample> air(participant);
  const Collector<ServiceStatus> status(participant);
  const SerialDevice device(folder / "air_data");
  const Process bridge("fathom-air-data-bridge",
                       bridge_arguments("air_data", kDomain, {serial(folder / "air_data")}), folder / "log");
  ASSERT_TRUE(eventually([&] { return air.matched() && status.matched(); })) << bridge.output();
  AirspeedSample sent;
  sent.airspeed_m_s = 48.0;
  sent.true_airspeed_m_s = 51.5;
  sent.baro_altitude_m = 900.0;
  const std::string good = encode::ascii_air_data(sent, {});
  std::string damaged = good;
  damaged[0] = damaged[0] == '9' ? '8' : '9';
  ASSERT_TRUE(eventually([&] {
    // No temperature in the last one: no true airspeed can be had of it. 310 kn are beyond what is
    // configured.
    device.send(bytes_of(good + damaged + "93.30,2952.7,*32\r\n" + "310.0,2952.7,8.5*1A\r\n"));
    return air.count() > 5 && counter(status, "rejected_checksum") > 3 &&
           counter(status, "rejected_incomplete") > 3 && counter(status, "refused_impossible") > 3;
  })) << bridge.output();
  for (const auto& each : air.all()) {
    EXPECT_EQ(each.header.sensor, "airspeed");
    EXPECT_EQ(each.header.stamp_ns, each.header.received_ns - 50 * kNsPerMillisecond);
    EXPECT_NEAR(each.airspeed_m_s, 48.0, 1e-3);
    EXPECT_NEAR(each.true_airspeed_m_s, 51.5, 5e-3);
    EXPECT_NEAR(each.baro_altitude_m, 900.0, 0.1);
  }
}

TEST(AirDataBridge, APitotTubeSpeaksXdrOrOpenVario) {
  constexpr int kDomain = 149;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<AirspeedSample> air(participant);
  const int port = free_port(SOCK_DGRAM);
  const Process bridge("fathom-air-data-bridge",
                       bridge_arguments("air_data", kDomain, {udp(port), "sensors.0.protocol=nmea_air_data"}),
                       folder / "log");
  ASSERT_TRUE(eventually([&] { return air.matched(); })) << bridge.output();
  AirspeedSample sent;
  sent.airspeed_m_s = 48.0;
  sent.true_airspeed_m_s = 51.5;
  sent.baro_altitude_m = 900.0;
  // 130 km/h are 36.1 m/s.
  const std::string vario = encode::nmea_sentence("POV,S,130.0");
  ASSERT_TRUE(eventually([&] {
    send_udp(port, bytes_of(air.count() < 4 ? encode::nmea_air_data(sent, {}) : vario));
    return air.count() > 8;
  })) << bridge.output();
  EXPECT_NEAR(air.all().front().true_airspeed_m_s, 51.5, 5e-3);
  EXPECT_NEAR(air.all().back().true_airspeed_m_s, 130.0 / 3.6, 1e-9);
  EXPECT_NEAR(air.all().back().baro_altitude_m, 900.0, 0.1);
}

TEST(BridgeProcess, BadConfigurationEndsWithOneLineBeforeAnythingStarts) {
  const TemporaryFolder folder;
  Process bridge("fathom-imu-bridge", bridge_arguments("imu", 147, {"sensors.0.rate_hz=-1"}), folder / "log");
  EXPECT_EQ(bridge.wait(), 2);
  const std::string file = source_dir() + "/deploy/config/imu_bridge.json";
  EXPECT_EQ(bridge.output(), "fathom-imu-bridge: " + file +
                                 ": sensors.0.rate_hz: is -1, expected a number from 0.001 to 10000\n");
  Process usage("fathom-imu-bridge", {"--nonsense"}, folder / "usage");
  EXPECT_EQ(usage.wait(), 2);
  Process no_file("fathom-imu-bridge", {"--check"}, folder / "no_file");
  EXPECT_EQ(no_file.wait(), 2);
  EXPECT_EQ(no_file.output(), "fathom-imu-bridge: --vehicle, --config or --folder is required; see --help\n");
  Process none("fathom-imu-bridge", {"--config", folder / "none.json"}, folder / "none");
  EXPECT_EQ(none.wait(), 2);
}

TEST(BridgeProcess, CheckAndVersionEndAtOnce) {
  const TemporaryFolder folder;
  for (const char* kind : {"imu", "dvl", "gps", "depth", "heading", "usbl", "actuator", "air_data"}) {
    auto arguments = bridge_arguments(kind, 147, {});
    arguments.emplace_back("--check");
    std::string name = std::string("fathom-") + kind + "-bridge";
    std::replace(name.begin(), name.end(), '_', '-');
    Process check(name, arguments, folder / kind);
    EXPECT_EQ(check.wait(), 0) << check.output();
    Process version(name, {"--version"}, folder / (std::string(kind) + "_version"));
    EXPECT_EQ(version.wait(), 0);
    EXPECT_EQ(version.output().rfind(name + " ", 0), 0U) << version.output();
    Process explain(name, {"--explain"}, folder / (std::string(kind) + "_explain"));
    EXPECT_EQ(explain.wait(), 0);
    EXPECT_NE(explain.output().find("\nsensors[].protocol "), std::string::npos) << explain.output();
  }
}

TEST(BridgeProcess, StopsPromptlyWithADeadInstrumentAndSaysSo) {
  constexpr int kDomain = 148;
  for (const int number : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder;
    bus::Participant participant(test_participant(kDomain));
    const Collector<ServiceStatus> status(participant);
    Process bridge("fathom-imu-bridge", bridge_arguments("imu", kDomain, {serial("/nonexistent/imu")}),
                   folder / "log");
    ASSERT_TRUE(eventually([&] { return is_in_state(status, ServiceState::degraded, "/nonexistent/imu"); }))
        << bridge.output();
    const ServiceStatus last = status.all().back();
    EXPECT_EQ(last.header.sensor, "imu_bridge");
    EXPECT_EQ(last.config_hash.size(), 16U);
    EXPECT_GT(last.pid, 0U);
    bridge.signal(number);
    EXPECT_EQ(bridge.wait(3.0), 0) << bridge.output();
    EXPECT_TRUE(eventually([&] { return is_in_state(status, ServiceState::stopping); }, 2.0));
  }
}

}  // namespace
}  // namespace fathom::test
