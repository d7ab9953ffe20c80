// What the file of a vehicle means for each service, and where each value came from.
#include <filesystem>
#include <map>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/bridge/bridge_config.hpp"
#include "config/doors/ros2_gateway_config.hpp"
#include "config/fusion/fusion_config.hpp"
#include "config/monitor_config.hpp"
#include "config/vehicle/folder.hpp"
#include "config/vehicle/provenance.hpp"
#include "unit/config/vehicle_file.hpp"

namespace fathom::config {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST_F(Vehicle, BridgeGetsItsInstruments) {
  const auto imu = load<ImuBridgeConfig>("imu_bridge");
  ASSERT_EQ(imu.sensors.size(), 1U);
  EXPECT_EQ(imu.sensors[0].sensor.protocol, "vectornav");
  EXPECT_EQ(imu.sensors[0].sensor.source.baud, 921600);
  EXPECT_EQ(imu.sensors[0].sensor.time.mode, runtime::TimeMode::device_clock);
  EXPECT_EQ(imu.common.vehicle, "auv");
  const auto dvl = load<DvlBridgeConfig>("dvl_bridge");
  EXPECT_EQ(dvl.sensors[0].sensor.source.port, 16171) << "from the catalogue";
  EXPECT_EQ(dvl.sensors[0].sensor.protocol, "waterlinked");
  EXPECT_NEAR(load<DepthBridgeConfig>("depth_bridge").sensors[0].latitude_rad, 0.63530, 1e-4);
}

TEST_F(Vehicle, LeversAreFromTheInertialUnit) {
  instrument("imu")["position_m"] = {1.0, 2.0, 3.0};
  const auto fusion = load<FusionConfig>("fusion");
  for (const estimation::SensorConfig& sensor : fusion.engine.sensors) {
    if (sensor.sensor != "dvl") continue;
    EXPECT_DOUBLE_EQ(sensor.lever_B_m[0], -0.5);
    EXPECT_DOUBLE_EQ(sensor.lever_B_m[1], -2.0);
    EXPECT_DOUBLE_EQ(sensor.lever_B_m[2], -2.8);
  }
  EXPECT_EQ(fusion.engine.sensors.size(), 5U) << "and the operator";
}

TEST_F(Vehicle, ABiasIsAtLeastAsUncertainAsItWanders) {
  const auto sigma_deg_h = [&] {
    return load<FusionConfig>("fusion").engine.imu.gyro_bias_sigma_rad_s * 180.0 / std::numbers::pi * 3600.0;
  };
  instrument("imu")["model"] = "vectornav_vn100";
  EXPECT_NEAR(sigma_deg_h(), 180.0, 1e-9) << "the catalogue says it";
  instrument("imu")["fusion"] = {{"gyro_bias_sigma_deg_h", 40.0}};
  EXPECT_NEAR(sigma_deg_h(), 40.0, 1e-9) << "what the vehicle says stays";
  instrument("imu")["fusion"] = {{"gyro_bias_instability_deg_h", 500.0}};
  EXPECT_NEAR(sigma_deg_h(), 500.0, 1e-9) << "the vehicle says how far it wanders in a run";
  instrument("imu")["fusion"] = {{"gyro_bias_instability_deg_h", 0.5}};
  EXPECT_NEAR(sigma_deg_h(), 180.0, 1e-9) << "the catalogue's is more";
}

TEST_F(Vehicle, MountingTurnsOnce) {
  instrument("imu")["mounting_rpy_deg"] = {0.0, 0.0, 90.0};
  instrument("imu")["axes"] = "flu";
  EXPECT_NEAR(load<FusionConfig>("fusion").engine.imu.mounting_rpy_rad[2], 1.5707963, 1e-6);
  const auto rotation = load<ImuBridgeConfig>("imu_bridge").sensors[0].mounting.rotation();
  EXPECT_DOUBLE_EQ(rotation[0], 1.0) << "the bridge renames the axes, and turns nothing";
  EXPECT_DOUBLE_EQ(rotation[4], -1.0);
}

TEST_F(Vehicle, MonitorExpectsWhatIsThere) {
  instrument("heading")["enabled"] = false;
  const auto monitor = load<MonitorConfig>("monitor");
  std::vector<std::string> services;
  for (const auto& one : monitor.health.services) services.push_back(one.name.str());
  EXPECT_THAT(services, ::testing::UnorderedElementsAre("fusion", "imu_bridge", "gps_bridge", "dvl_bridge",
                                                        "depth_bridge", "recorder"));
  EXPECT_EQ(monitor.health.sensors.size(), 4U);
  EXPECT_TRUE(monitor.health.gps.expected);
}

TEST_F(Vehicle, AnInstrumentMayBeATopicOfRos2) {
  instrument("imu").erase("port");
  instrument("imu")["axes"] = "flu";
  instrument("imu")["ros2"] = {{"topic", "/imu/data"}, {"frame_id", "imu_link"}};
  instrument("depth").erase("port");
  instrument("depth")["ros2"] = {{"topic", "/pressure"}, {"frame_id", ""}, {"atmosphere_Pa", 0.0}};
  const auto gateway = load<Ros2GatewayConfig>("ros2_gateway");
  ASSERT_EQ(gateway.inputs.size(), 2U);
  EXPECT_EQ(gateway.inputs[0].kind, RosInputKind::imu);
  EXPECT_EQ(gateway.inputs[0].sensor, Name("imu"));
  EXPECT_EQ(gateway.inputs[0].rate_hz, 100.0);
  EXPECT_EQ(gateway.inputs[0].axes, RosAxes::flu);
  EXPECT_EQ(gateway.inputs[1].kind, RosInputKind::fluid_pressure);
  EXPECT_NEAR(gateway.inputs[1].latitude_rad, 36.4 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_EQ(gateway.inputs[1].atmosphere_Pa, 0.0);
  std::vector<std::string> services;
  for (const auto& one : load<MonitorConfig>("monitor").health.services) services.push_back(one.name.str());
  EXPECT_THAT(services, ::testing::UnorderedElementsAre("fusion", "ros2_gateway", "gps_bridge", "dvl_bridge",
                                                        "heading_bridge", "recorder"));
  EXPECT_EQ(load<FusionConfig>("fusion").engine.sensors.size(), 5U)
      << "fusion does not care where it comes from";
  EXPECT_EQ(complaint(), "");
  instrument("imu")["port"] = {{"type", "serial"}, {"path", "/dev/ttyUSB0"}};
  EXPECT_THAT(complaint(), HasSubstr("instruments.0.ros2"));
}

TEST_F(Vehicle, WhatNeedNotSpeakIsNotMissed) {
  instrument("heading")["watched"] = false;
  const auto monitor = load<MonitorConfig>("monitor");
  EXPECT_EQ(monitor.health.sensors.size(), 4U);
  EXPECT_EQ(load<FusionConfig>("fusion").engine.sensors.size(), 5U) << "it is used all the same";
}

TEST_F(Vehicle, AnInstrumentIsTurnedOnce) {
  instrument("imu")["mounting_rpy_deg"] = {0, 0, 90};
  EXPECT_EQ(complaint(), "");
  instrument("imu")["bridge"] = {{"mounting", {{"frame", "frd"}, {"rpy_deg", {0, 0, 90}}}}};
  EXPECT_THAT(complaint(),
              HasSubstr("because instruments.0.bridge.mounting.rpy_deg turns the same instrument"));
  instrument("imu")["mounting_rpy_deg"] = {0, 0, 0};
  EXPECT_EQ(complaint(), "");
  instrument("dvl")["mounting_rpy_deg"] = {0, 0, 45};
  instrument("dvl")["protocol"] = "pd0";
  instrument("dvl")["bridge"] = {{"heading_alignment_deg", 45}};
  EXPECT_THAT(complaint(), HasSubstr("instruments.2.bridge.heading_alignment_deg turns"));
}

TEST_F(Vehicle, InstrumentsOfOneNameAreKeptApartByTheirKind) {
  for (const char* kind : {"propulsion", "fins"}) {
    file["instruments"].push_back({{"name", "actuator"},
                                   {"kind", kind},
                                   {"protocol", "nmea0183"},
                                   {"rate_hz", 5.0},
                                   {"port", {{"type", "udp"}, {"address", "127.0.0.1"}, {"port", 10120}}}});
  }
  file["services"]["fusion"]["engine"]["sensors"] = {
      {{"sensor", "actuator"}, {"kind", "fins"}, {"enabled", false}}};
  const auto fusion = load<FusionConfig>("fusion");
  ASSERT_EQ(fusion.engine.sensors.size(), 7U);
  EXPECT_TRUE(fusion.engine.sensors[4].enabled);
  EXPECT_FALSE(fusion.engine.sensors[5].enabled);
  EXPECT_EQ(load<ActuatorBridgeConfig>("actuator_bridge").sensors.size(), 1U);
}

TEST_F(Vehicle, AFolderHoldsTheVehicleTheServicesOrBoth) {
  const std::string at = folder.string();
  EXPECT_THAT(([&]() -> std::string {
                try {
                  (void)from_folder({}, at, "gps_bridge");
                } catch (const ConfigError& error) {
                  return error.what();
                }
                return "";
              })(),
              HasSubstr("has neither vehicle.json nor gps_bridge.json"));
  const auto speed = [&] {
    return load_service_config<GpsBridgeConfig>(from_folder({}, at, "gps_bridge")).value.sensors[0];
  };
  // As a vehicle was configured before there was a vehicle.json.
  std::filesystem::copy_file(test::source_dir() + "/deploy/config/gps_bridge.json",
                             folder / "gps_bridge.json");
  EXPECT_DOUBLE_EQ(speed().sensor.time.latency_s, 0.1);
  const LoadRequest before = from_folder({}, at, "gps_bridge");
  EXPECT_EQ(before.base, nullptr);
  EXPECT_EQ(
      load_service_config<GpsBridgeConfig>(before).hash,
      load_service_config<GpsBridgeConfig>({test::source_dir() + "/deploy/config/gps_bridge.json", {}}).hash);
  (void)vehicle();
  EXPECT_DOUBLE_EQ(speed().sensor.time.latency_s, 0.1) << "the service's own file goes before";
  EXPECT_THAT(files_of(from_folder({}, at, "gps_bridge")), HasSubstr("vehicle.json, over it "));
  std::filesystem::remove(folder / "gps_bridge.json");
  EXPECT_DOUBLE_EQ(speed().sensor.time.latency_s, 0.05);
  EXPECT_EQ(speed().sensor.rate_hz, 2.0);
}

TEST_F(Vehicle, EachFusionHasItsRole) {
  file["roles"]["fusion"] = {{{"name", "first"}, {"strength", 20}}, {{"name", "second"}, {"strength", 5}}};
  EXPECT_EQ(load<FusionConfig>("fusion").ownership_strength, 20);
  const auto second = load<FusionConfig>("fusion", {"", {"instance=second"}});
  EXPECT_EQ(second.instance, "second");
  EXPECT_EQ(second.ownership_strength, 5);
  EXPECT_TRUE(second.standby.enabled);
}

TEST_F(Vehicle, OwnFileAndCommandLineGoBefore) {
  const std::string own =
      write("gps_bridge.json", {{"sensors", {{{"name", "gps"}, {"max_speed_m_s", 50.0}}}}});
  const auto gps = load<GpsBridgeConfig>("gps_bridge", {own, {"log.level=debug"}});
  EXPECT_DOUBLE_EQ(gps.sensors[0].max_speed_m_s, 50.0);
  EXPECT_DOUBLE_EQ(gps.sensors[0].sensor.rate_hz, 2.0) << "from the vehicle still";
  EXPECT_EQ(gps.common.log.level, "debug");
}

TEST_F(Vehicle, FurtherKeysOfAService) {
  file["services"]["recorder"] = {{"files", {{"quota_mb", 2048.0}}}};
  EXPECT_EQ(complaint(), "");
  file["services"]["recorder"] = {{"quota", 1}};
  EXPECT_THAT(complaint(), HasSubstr("vehicle.json: services.recorder.quota: is 1, expected no such key"));
  file["services"] = {{"recoder", json::object()}};
  EXPECT_THAT(complaint(), HasSubstr("services.recoder: is {}, expected one of imu_bridge, "));
}

TEST_F(Vehicle, PortsThatCollideAreRefused) {
  const json good = file;
  const auto said = [&](const std::string& name, const json& port) {
    instrument(name)["port"] = port;
    return complaint();
  };
  const auto udp = [](const char* address, int port, const char* group) {
    return json{{"type", "udp"}, {"address", address}, {"port", port}, {"multicast", group}};
  };
  const json serial = {{"type", "serial"}, {"path", "/dev/ttyS7"}, {"baud", 9600}};
  EXPECT_EQ(said("imu", serial), "");
  EXPECT_THAT(said("gps", serial), HasSubstr("expected a port of its own: imu reads from it as well"));
  EXPECT_THAT(complaint(), HasSubstr("instruments.1.port"));
  EXPECT_THAT(complaint(), HasSubstr("the same port with shared: true in each"));
  instrument("gps")["enabled"] = false;
  EXPECT_EQ(complaint(), "") << "what is left out reads nothing";
  file = good;
  json shared = serial;
  shared["shared"] = true;
  EXPECT_EQ(said("imu", shared), "");
  EXPECT_THAT(said("gps", serial), HasSubstr("a port of its own")) << "only one of them shares it";
  EXPECT_EQ(said("gps", shared), "");
  shared["baud"] = 19200;
  EXPECT_THAT(said("gps", shared), HasSubstr("a port of its own")) << "a line has one rate";
  file = good;
  EXPECT_EQ(said("imu", udp("127.0.0.1", 5000, "")), "");
  EXPECT_EQ(said("gps", udp("127.0.0.2", 5000, "")), "");
  EXPECT_THAT(said("gps", udp("127.0.0.1", 5000, "")), HasSubstr("a port of its own"));
  EXPECT_THAT(said("gps", udp("0.0.0.0", 5000, "")), HasSubstr("a port of its own"));
  EXPECT_EQ(said("gps", udp("0.0.0.0", 5001, "")), "");
  EXPECT_EQ(said("gps", udp("0.0.0.0", 5000, "239.1.2.3")), "");
  EXPECT_EQ(said("imu", udp("0.0.0.0", 5000, "239.1.2.3")), "") << "any number may join a group";
  EXPECT_THAT(said("gps", udp("0.0.0.0", 5001, "10.1.2.3")),
              HasSubstr("instruments.1.port.multicast: is \"10.1.2.3\", expected the address of a group"));
  EXPECT_EQ(said("gps", udp("::", 5001, "ff02::1")), "");
  EXPECT_THAT(said("gps", udp("::", 5001, "239.1.2.3")), HasSubstr("port.address: is \"::\""));
}

TEST_F(Vehicle, OfOneBridgeNoTwoInstrumentsShareAPort) {
  json twin = instrument("gps");
  twin["name"] = "gps_two";
  file["instruments"].push_back(twin);
  const std::string both = complaint();
  EXPECT_THAT(both, HasSubstr(".port: is ")) << "gps reads from it";
}

TEST_F(Vehicle, WhatIsExpectedCanBeThere) {
  file["roles"]["expected"] = {"recorder", "console"};
  EXPECT_EQ(complaint(), "");
  file["roles"]["expected"] = {"recorder", "consol"};
  EXPECT_THAT(complaint(), HasSubstr("roles.expected.1: is \"consol\", expected one of"));
  EXPECT_THAT(complaint(), HasSubstr("; the nearest is console"));
}

TEST_F(Vehicle, AnInertialUnitSpeaksWhatItsModelSpeaks) {
  instrument("imu")["model"] = "vectornav_vn100";
  instrument("imu")["protocol"] = "vectornav";
  EXPECT_EQ(complaint(), "");
  instrument("imu")["protocol"] = "mavlink";
  EXPECT_THAT(complaint(), HasSubstr("instruments.0.protocol: is \"mavlink\", expected \"vectornav\", which "
                                     "vectornav_vn100 speaks"));
}

TEST_F(Vehicle, ComplaintsNameTheKeyOfTheVehicle) {
  ASSERT_EQ(complaint(), "");
  const json good = file;
  const auto said = [&](const std::string& name, const std::string& key, const json& value) {
    file = good;
    if (value.is_null()) {
      instrument(name).erase(key);
    } else {
      instrument(name)[key] = value;
    }
    return complaint();
  };
  EXPECT_THAT(said("dvl", "mounting_rpy_deg", nullptr),
              HasSubstr("instruments.2.mounting_rpy_deg: is missing"));
  EXPECT_THAT(said("gps", "position_m", nullptr), HasSubstr("instruments.1.position_m: is missing"));
  EXPECT_THAT(said("gps", "port", nullptr), HasSubstr("instruments.1.port: is missing"));
  EXPECT_THAT(said("gps", "protocol", nullptr), HasSubstr("instruments.1.protocol: is missing"));
  EXPECT_THAT(said("imu", "rate_hz", nullptr), HasSubstr("instruments.0.rate_hz: is missing"));
  EXPECT_THAT(said("depth", "bridge", nullptr), HasSubstr("instruments.3.bridge.unit: is missing"));
  EXPECT_THAT(said("gps", "fusion", {{"sigma_deg", {1, 1, 1}}}), HasSubstr("instruments.1.fusion.sigma_deg"));
  EXPECT_THAT(said("gps", "protocol", "morse"), HasSubstr("instruments.1.protocol: is \"morse\""));
  EXPECT_THAT(said("imu", "model", "vectornav_vn10"), HasSubstr("the nearest is vectornav_vn100"));
  EXPECT_THAT(said("gps", "model", "vectornav_vn100"), HasSubstr("instruments.1.kind"));
  file = good;
  file.erase("latitude_deg");
  EXPECT_THAT(complaint(), HasSubstr("latitude_deg: is missing"));
  file = good;
  instrument("imu")["enabled"] = false;
  EXPECT_THAT(complaint(), HasSubstr("instruments: is"));
}

TEST_F(Vehicle, EachValueSaysWhereItCameFrom) {
  for (const ConfigKind& kind : config_kinds()) {
    if (kind.name != "dvl_bridge") continue;
    const auto values = provenance(kind, with_vehicle({"", {"log.level=debug"}}, vehicle(), "dvl_bridge"));
    std::map<std::string, Layer> from;
    for (const Provenance& one : values) from[one.key] = one.origin.layer;
    EXPECT_EQ(from.at("sensors.0.source.port"), Layer::catalogue);
    EXPECT_EQ(from.at("sensors.0.protocol"), Layer::catalogue);
    EXPECT_EQ(from.at("sensors.0.rate_hz"), Layer::vehicle);
    EXPECT_EQ(from.at("sensors.0.source.silence_s"), Layer::standard);
    EXPECT_EQ(from.at("log.level"), Layer::command_line);
    EXPECT_FALSE(from.contains("sensors.0.heading_alignment_deg")) << "means nothing to this protocol";
  }
}

}  // namespace
}  // namespace fathom::config
