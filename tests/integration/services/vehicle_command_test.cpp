// One file for a vehicle, as people use it: with the services, with config show and with solve.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "solve_fixture.hpp"

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
  int run(const std::string& program, const std::vector<std::string>& arguments) {
    Process process(program, arguments);
    const int code = process.wait();
    out = process.out();
    err = process.err();
    return code;
  }
};

TEST_F(VehicleCommand, SolveRunsFusionAsTheVehicleWould) {
  dataset::write(path("data"), StraightCourse(true).data);
  ASSERT_EQ(solve({"--start", "reference"}), 0) << err;
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

}  // namespace
}  // namespace fathom::test
