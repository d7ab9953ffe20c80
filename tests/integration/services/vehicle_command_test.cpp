// One file for a vehicle, as people use it: with the services, with config show and with solve.
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "solve_fixture.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class VehicleCommand : public SolveTest {
 protected:
  void SetUp() override {
    SolveTest::SetUp();
    write("vehicle.json", R"({
      "name": "auv",
      "instruments": [
        {"name": "imu", "kind": "imu", "protocol": "vectornav", "rate_hz": 100,
         "port": {"type": "serial", "path": "/dev/ttyUSB0"}, "position_m": [1, 0, 0], "mounting_rpy_deg": [0, 0, 0]},
        {"name": "gps0", "kind": "gps", "model": "ublox_zed_f9p", "rate_hz": 2,
         "port": {"type": "serial", "path": "/dev/ttyUSB1"}, "position_m": [1, 0, 0]},
        {"name": "dvl0", "kind": "dvl", "protocol": "pd0", "rate_hz": 1, "position_m": [1, 0, 0],
         "port": {"type": "udp", "address": "127.0.0.1", "port": 17002}, "mounting_rpy_deg": [0, 0, 0]}
      ],
      "services": {"fusion": {"engine": {"configuration": "gps_ins15"}}}
    })");
  }
};

TEST_F(VehicleCommand, SolveRunsFusionAsTheVehicleWould) {
  dataset::write(path("data"), StraightCourse(true).data);
  // Of an IMU of no model, as a vehicle has it.
  std::vector<std::string> said{"--start", "reference"};
  for (const char* const figure :
       {"gyro_bias_sigma_deg_h=180", "accel_bias_sigma_m_s2=0.02942", "gyro_scale_sigma=0.001",
        "accel_scale_sigma=0.001", "gyro_misalignment_sigma_deg=0.05", "accel_misalignment_sigma_deg=0.05",
        "angle_random_walk_deg_sqrt_h=0.3", "velocity_random_walk_m_s_sqrt_h=0.08",
        "gyro_bias_instability_deg_h=10"}) {
    said.insert(said.end(), {"--set", std::string("engine.imu.") + figure});
  }
  ASSERT_EQ(solve(said), 0) << err;
  const std::string by_file = content("nav.csv");
  ASSERT_EQ(run("fathom", {"solve", path("data"), "--vehicle", path("vehicle.json"), "--out", path("nav.csv"),
                           "--start", "reference", "--metrics", path("m.json")}),
            0)
      << err;
  EXPECT_EQ(content("nav.csv"), by_file) << "the same configuration said in two ways";
  EXPECT_EQ(nlohmann::json::parse(content("m.json"))["config"], path("vehicle.json"));
  EXPECT_EQ(run("fathom", {"solve", path("data"), "--out", path("nav.csv")}), 2);
  EXPECT_THAT(err, HasSubstr("--vehicle or --config is required"));
}

TEST_F(VehicleCommand, AFileOfTheServicesOwnGoesBefore) {
  ASSERT_EQ(run("fathom-gps-bridge", {"--vehicle", path("vehicle.json"), "--check"}), 0) << err;
  EXPECT_EQ(out, "fathom-gps-bridge: " + path("vehicle.json") + ": valid\n");
  write("gps_bridge.json", R"({"sensors": [{"name": "gps0", "max_speed_m_s": 30}]})");
  ASSERT_EQ(run("fathom-gps-bridge", {"--folder", folder.string(), "--check"}), 0) << err;
  EXPECT_THAT(out, HasSubstr("vehicle.json, over it "));
  ASSERT_EQ(run("fathom", {"config", "show", "gps_bridge", "--folder", folder.string(), "--said"}), 0) << err;
  EXPECT_THAT(out, ::testing::ContainsRegex(
                       "sensors.0.max_speed_m_s +30 +override +[^ ]*gps_bridge.json: sensors.0"));
  EXPECT_THAT(out, ::testing::ContainsRegex(
                       "sensors.0.protocol +\"ubx\" +catalogue +[^ ]*ublox_zed_f9p.json: protocol"));
  EXPECT_THAT(out, ::testing::ContainsRegex(
                       "sensors.0.rate_hz +2 +vehicle +[^ ]*vehicle.json: instruments.1.rate_hz"));
  EXPECT_THAT(out, Not(HasSubstr("default")));
  ASSERT_EQ(run("fathom", {"config", "show", "gps_bridge", "--vehicle", path("vehicle.json"), "--said",
                           "--set", "bus.domain=7"}),
            0)
      << err;
  EXPECT_THAT(out, ::testing::ContainsRegex("bus.domain +7 +command line +--set bus.domain\n"));
  EXPECT_THAT(out, Not(HasSubstr("override")));
  write("gps_bridge.json", R"({"sensors": [{"name": "gps0", "max_speed": 30}]})");
  EXPECT_EQ(run("fathom-gps-bridge", {"--folder", folder.string(), "--check"}), 2);
  EXPECT_EQ(err,
            "fathom-gps-bridge: " + path("gps_bridge.json") +
                ": sensors.0.max_speed: is 30, expected no such key; the nearest is max_speed_m_s; known "
                "keys: " +
                err.substr(err.find("known keys: ") + 12));
}

TEST_F(VehicleCommand, WhatIsWrongIsNamedWhereItWasWritten) {
  EXPECT_EQ(run("fathom", {"config", "show", "fusio", "--vehicle", path("vehicle.json")}), 2);
  EXPECT_THAT(err, HasSubstr("fusio: no such service; nearest is fusion"));
  for (const char* program : {"gps-bridge", "fathom-gps-bridge"})
    EXPECT_EQ(run("fathom", {"config", "show", program, "--vehicle", path("vehicle.json")}), 0) << err;
  EXPECT_EQ(run("fathom-gps-bridge", {"--vehicle", path("vehicle.json"), "--config", "", "--check"}), 2);
  EXPECT_THAT(err, HasSubstr("--config: is empty, expected a value"));
  EXPECT_EQ(run("fathom", {"config", "show", "usbl_bridge", "--vehicle", path("vehicle.json")}), 2);
  EXPECT_THAT(err, HasSubstr("vehicle.json: instruments: is without any for usbl_bridge"));
  for (const auto& [text, complaint] :
       {std::pair{"[]", "vehicle.json: (whole file): is [], expected an object"},
        {R"({"name": "auv"})", "vehicle.json: instruments: is missing"},
        {R"({"name": "auv", "instruments": []})", "instruments: is []"},
        {R"({"name": "auv", "instrumens": []})", "the nearest is instruments"},
        {"{\"name\": \"auv\",\n", "vehicle.json:2: is not JSON"}}) {
    write("vehicle.json", text);
    EXPECT_EQ(run("fathom-fusion", {"--vehicle", path("vehicle.json"), "--check"}), 2) << text;
    EXPECT_THAT(err, HasSubstr(complaint));
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
  }
}

TEST_F(VehicleCommand, AllThatIsWrongIsSaidALineEach) {
  write("vehicle.json", R"({
      "name": "auv",
      "instruments": [
        {"name": "imu", "kind": "imu", "model": "vectornav_vn10",
         "port": {"type": "serial", "path": "/dev/ttyUSB0"}, "position_m": [1, 0], "mounting_rpy_deg": [0, 0, 0]},
        {"name": "gps", "kind": "gps", "lever_m": [1, 0, 0],
         "port": {"type": "serial", "path": "/dev/ttyUSB0"}}
      ]
    })");
  fs::create_directory(path("data"));
  const auto lines = [&](const std::string& program) {
    const std::string begin = program + ": " + path("vehicle.json") + ": instruments.";
    return "^" + begin + "0\\.position_m: is [^\n]*\n" + begin + "1\\.lever_m: is [^\n]*\n" + begin +
           "1\\.position_m: is missing[^\n]*\n" + begin + "1\\.port: is [^\n]*\n" + begin +
           "0\\.model: is [^\n]*\n$";
  };
  EXPECT_EQ(
      run("fathom", {"solve", path("data"), "--vehicle", path("vehicle.json"), "--out", path("nav.csv")}), 2);
  EXPECT_THAT(err, ::testing::MatchesRegex(lines("fathom")));
  EXPECT_EQ(run("fathom-fusion", {"--vehicle", path("vehicle.json"), "--check"}), 2);
  EXPECT_THAT(err, ::testing::MatchesRegex(lines("fathom-fusion")));
}

// From nothing to a file that services start with: instruments that speak on pseudo-terminals, UDP and TCP.
TEST_F(VehicleCommand, InitFindsTheInstrumentsAndWritesTheVehicle) {
  const std::string source = source_dir();
  Process simulator(
      "fathom-simulator",
      {"--config", source + "/deploy/config/simulator.json", "--set",
       "scenario_dir=" + source + "/deploy/config/scenarios", "--set",
       "bus.profiles_dir=" + source + "/deploy/dds", "--set", "bus.domain=202", "--set", "port_offset=3300",
       "--set", "link_dir=" + path("dev"), "--set", "clock.anchor_file=" + path("clock")});
  ASSERT_TRUE(wait_until([&] { return fs::exists(folder / "dev/imu"); }));
  const std::vector<std::string> arguments{
      "init",  "--serial",        path("dev/imu"), "--serial", path("dev/depth"), "--udp", "127.0.0.1:20301",
      "--tcp", "127.0.0.1:20302", "--yes",         "--out",    path("found.json")};
  ASSERT_EQ(run("fathom", arguments), 0) << err << out;
  std::map<std::string, nlohmann::json> found;
  const auto vehicle = nlohmann::json::parse(content("found.json"));
  for (const auto& one : vehicle["instruments"]) found[one["name"]] = one;
  ASSERT_EQ(found.size(), 4U) << out;
  EXPECT_EQ(found["imu"]["protocol"], "vectornav");
  EXPECT_EQ(found["imu"]["rate_hz"], 100.0);
  EXPECT_EQ(found["imu"]["mounting_rpy_deg"], nlohmann::json::parse("[0.0, 0.0, 0.0]"));
  EXPECT_EQ(found["gps"]["protocol"], "nmea0183");
  EXPECT_EQ(found["gps"]["rate_hz"], 2.0);
  EXPECT_EQ(found["dvl"]["protocol"], "pd0");
  EXPECT_EQ(found["dvl"]["rate_hz"], 5.0);
  EXPECT_EQ(found["depth"]["bridge"]["unit"], "psi");
  EXPECT_NEAR(vehicle["latitude_deg"].get<double>(), 36.4, 0.051) << "of a fix that was heard";
  for (const char* service : {"fathom-imu-bridge", "fathom-gps-bridge", "fathom-dvl-bridge", "fathom-fusion"})
    EXPECT_EQ(run(service, {"--vehicle", path("found.json"), "--check"}), 0) << err;
  EXPECT_EQ(run("fathom", arguments), 2);
  EXPECT_THAT(err, HasSubstr("is there already"));
}

TEST_F(VehicleCommand, InitWritesNothingWithoutAnInertialUnit) {
  EXPECT_EQ(
      run("fathom", {"init", "--udp", "127.0.0.1:20399", "--seconds", "1", "--out", path("found.json")}), 1);
  EXPECT_THAT(out, HasSubstr("nothing was heard"));
  EXPECT_THAT(out, HasSubstr("Listening to 1 port for"));
  EXPECT_THAT(err, HasSubstr("no inertial unit was recognised"));
  EXPECT_FALSE(fs::exists(folder / "found.json"));
  EXPECT_EQ(run("fathom", {"init", "--serial", "/etc/passwd", "--seconds", "1", "--out", path("found.json")}),
            1);
  EXPECT_THAT(out, HasSubstr("serial /etc/passwd: is no serial port"));
}

}  // namespace
}  // namespace fathom::test
