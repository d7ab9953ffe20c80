// Which services `fathom run` starts for which vehicle, in which order, and where they write.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/run/plan.hpp"
#include "config/registry.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::cli {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

const std::string kShipped = test::source_dir() + "/deploy/config/";

class RunOfVehicle : public ::testing::Test {
 protected:
  RunOfVehicle() {
    request.folder = "/tmp/of_the_run";
    request.executables = folder.path();
    std::ofstream(folder.path() / "fathom-console");
  }

  RunPlan plan(const json& vehicle) {
    request.vehicle = (folder.path() / "vehicle.json").string();
    std::ofstream(request.vehicle) << vehicle;
    return plan_run(request);
  }
  Words names_of_shipped(const std::string& file) {
    request.vehicle = kShipped + file;
    return names(plan_run(request));
  }
  std::string complaint(const json& vehicle) {
    try {
      (void)plan(vehicle);
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::bad_configuration);
      return failure.what();
    }
    return "";
  }

  static Words names(const RunPlan& plan) {
    Words out;
    for (const RunService& one : plan.services) out.push_back(one.program.name);
    return out;
  }
  static json bench() {
    return {{"name", "bench"},
            {"instruments",
             {{{"name", "imu"},
               {"kind", "imu"},
               {"protocol", "vectornav"},
               {"rate_hz", 100},
               {"position_m", {0, 0, 0}},
               {"mounting_rpy_deg", {0, 0, 0}},
               {"port", {{"type", "serial"}, {"path", "/dev/ttyUSB0"}, {"baud", 115200}}}},
              {{"name", "gps"},
               {"kind", "gps"},
               {"protocol", "ubx"},
               {"rate_hz", 5},
               {"position_m", {0, 0, 0}},
               {"port", {{"type", "serial"}, {"path", "/dev/ttyUSB1"}, {"baud", 115200}}}}}}};
  }
  /// What a service of the plan runs with.
  static json effective(const RunPlan& plan, const std::string& name) {
    for (const RunService& one : plan.services) {
      if (one.program.name != name) continue;
      for (const config::ConfigKind& kind : config::config_kinds()) {
        if (kind.name == one.service) return json::parse(kind.effective(one.configuration));
      }
    }
    ADD_FAILURE() << name << " is not in the plan";
    return {};
  }

  test::TemporaryFolder folder;
  RunRequest request;
};

TEST_F(RunOfVehicle, TheShippedVehicleHasABridgeForEachKindOfInstrument) {
  EXPECT_EQ(names_of_shipped("vehicle.json"),
            (Words{"fusion", "monitor", "recorder", "console", "depth_bridge", "dvl_bridge", "gps_bridge",
                   "heading_bridge", "imu_bridge"}));
}

TEST_F(RunOfVehicle, OneBridgeServesSeveralKindsAndWhatTheFileNamesRunsToo) {
  EXPECT_EQ(names_of_shipped("demo/vehicle.json"),
            (Words{"fusion", "monitor", "guidance_example", "console", "actuator_bridge", "air_data_bridge",
                   "altimeter_bridge", "depth_bridge", "dvl_bridge", "fix_bridge", "gps_bridge",
                   "heading_bridge", "imu_bridge", "range_bridge", "usbl_bridge"}));
}

TEST_F(RunOfVehicle, EveryServiceIsToldTheVehicleAndItsOverrides) {
  const RunPlan made = plan(bench());
  ASSERT_EQ(names(made), (Words{"fusion", "monitor", "console", "gps_bridge", "imu_bridge"}));
  const launch::Program& gps = made.services[3].program;
  EXPECT_EQ(gps.executable, folder.path() / "fathom-gps-bridge");
  EXPECT_EQ(gps.arguments,
            (Words{"--vehicle", request.vehicle, "--set", "clock.anchor_file=/tmp/of_the_run/clock"}));
  EXPECT_EQ(made.vehicle, "bench");
}

TEST_F(RunOfVehicle, ABuildWithoutAConsoleRunsNone) {
  std::filesystem::remove(folder.path() / "fathom-console");
  const RunPlan made = plan(bench());
  EXPECT_EQ(names(made), (Words{"fusion", "monitor", "gps_bridge", "imu_bridge"}));
  EXPECT_EQ(console_address(made), "");
}

TEST_F(RunOfVehicle, AnInstrumentThatIsLeftOutTakesItsBridgeWithIt) {
  json vehicle = bench();
  vehicle["instruments"][1]["enabled"] = false;
  vehicle["services"]["gps_bridge"] = {{"log", {{"level", "debug"}}}};
  EXPECT_EQ(names(plan(vehicle)), (Words{"fusion", "monitor", "console", "imu_bridge"}));
}

TEST_F(RunOfVehicle, DoorsRunWhereTheFileNamesThemAndTheSimulatorNever) {
  json vehicle = bench();
  vehicle["services"] = {
      {"nmea_out", json::object()}, {"discovery", json::object()}, {"simulator", json::object()}};
  vehicle["roles"] = {{"expected", {"recorder", "foxglove", "simulator"}}};
  EXPECT_EQ(names(plan(vehicle)), (Words{"discovery", "fusion", "monitor", "recorder", "foxglove", "nmea_out",
                                         "console", "gps_bridge", "imu_bridge"}));
}

TEST_F(RunOfVehicle, AnInstrumentOfRos2StartsWithTheBridges) {
  json vehicle = bench();
  vehicle["instruments"][1].erase("port");
  vehicle["instruments"][1].erase("protocol");
  vehicle["instruments"][1]["ros2"] = {{"topic", "/fix"}, {"frame_id", ""}};
  EXPECT_EQ(names(plan(vehicle)), (Words{"fusion", "monitor", "console", "imu_bridge", "ros2_gateway"}));
  vehicle = bench();
  vehicle["services"]["ros2_gateway"] = json::object();
  EXPECT_EQ(names(plan(vehicle)),
            (Words{"fusion", "monitor", "ros2_gateway", "console", "gps_bridge", "imu_bridge"}));
}

TEST_F(RunOfVehicle, WhatIsWrittenLiesInTheFolderUnlessSomebodySaysAnotherPlace) {
  request.record = "/tmp/recordings";
  RunPlan made = plan(bench());
  EXPECT_EQ(effective(made, "fusion")["checkpoint"]["path"], "/tmp/of_the_run/fusion.checkpoint");
  EXPECT_EQ(effective(made, "monitor")["journal"]["path"], "/tmp/of_the_run/alarms.jsonl");
  EXPECT_EQ(effective(made, "recorder")["folder"], "/tmp/recordings");
  for (const std::string& name : names(made))
    EXPECT_EQ(effective(made, name)["clock"]["anchor_file"], "/tmp/of_the_run/clock") << name;

  json vehicle = bench();
  vehicle["services"] = {{"fusion", {{"checkpoint", {{"path", "/data/checkpoint"}}}}},
                         {"recorder", json::object()}};
  request.record.clear();
  request.sets = {"monitor.journal.path=/data/alarms", "clock.anchor_file=/data/clock"};
  made = plan(vehicle);
  EXPECT_EQ(effective(made, "fusion")["checkpoint"]["path"], "/data/checkpoint");
  EXPECT_EQ(effective(made, "monitor")["journal"]["path"], "/data/alarms");
  EXPECT_EQ(effective(made, "imu_bridge")["clock"]["anchor_file"], "/data/clock");
  EXPECT_EQ(effective(made, "recorder")["folder"], "/tmp/of_the_run/recordings");
}

TEST_F(RunOfVehicle, SeveralFusionsEachHaveTheirNameAndCheckpoint) {
  json vehicle = bench();
  vehicle["roles"]["fusion"] = {{{"name", "fusion"}, {"strength", 10}}, {{"name", "spare"}, {"strength", 5}}};
  vehicle["network"]["security"] = {{"folder", "/etc/fathom/credentials"}};
  const RunPlan made = plan(vehicle);
  ASSERT_EQ(names(made), (Words{"fusion", "spare", "monitor", "console", "gps_bridge", "imu_bridge"}));
  EXPECT_EQ(made.services[1].program.executable, folder.path() / "fathom-fusion");
  const json spare = effective(made, "spare");
  EXPECT_EQ(spare["instance"], "spare");
  EXPECT_EQ(spare["ownership_strength"], 5);
  EXPECT_EQ(spare["standby"]["enabled"], true);
  EXPECT_EQ(spare["checkpoint"]["path"], "/tmp/of_the_run/spare.checkpoint");
  EXPECT_EQ(spare["bus"]["security"]["identity"], "fusion");
  EXPECT_EQ(effective(made, "fusion")["bus"]["security"]["identity"], "");

  request.without = {"fusion"};  // the one that is called so, for another machine has it
  EXPECT_EQ(names(plan(vehicle)), (Words{"spare", "monitor", "console", "gps_bridge", "imu_bridge"}));
  vehicle["roles"]["fusion"][0]["name"] = "first";
  EXPECT_EQ(names(plan(vehicle)), (Words{"monitor", "console", "gps_bridge", "imu_bridge"}));
}

TEST_F(RunOfVehicle, AnOverrideIsOfEveryServiceOrOfTheNamedOne) {
  request.sets = {"bus.domain=3", "fusion.checkpoint.period_s=2", "console.http.port=9000"};
  request.without = {"console"};  // what is said of it is no mistake
  const RunPlan made = plan(bench());
  EXPECT_EQ(effective(made, "imu_bridge")["bus"]["domain"], 3);
  EXPECT_EQ(effective(made, "fusion")["checkpoint"]["period_s"], 2.0);
  EXPECT_EQ(made.services.back().program.arguments.size(), 6U);
}

TEST_F(RunOfVehicle, AMistakeOnTheCommandLineIsRefused) {
  request.sets = {"checkpoint.period_s=2"};
  EXPECT_NE(complaint(bench()).find("run: --set checkpoint.period_s=2: expected a section"),
            std::string::npos);
  request.sets = {"dvl_bridge.rate_hz=2"};
  EXPECT_NE(complaint(bench()).find("there are vehicle, bus, log, clock, realtime, fusion"),
            std::string::npos);
  request.sets = {"fusion=2"};
  EXPECT_NE(complaint(bench()).find("--set fusion=2"), std::string::npos);
  request.sets = {};
  request.without = {"recordr"};
  EXPECT_NE(complaint(bench()).find("--without recordr: no such service, the nearest is recorder"),
            std::string::npos);
  request.without = {"recorder"};  // there is none, and so be it
  EXPECT_EQ(complaint(bench()), "");
  request.without = {"fusion", "monitor", "console", "gps_bridge", "imu_bridge"};
  EXPECT_NE(complaint(bench()).find("leaves no service"), std::string::npos);
}

TEST_F(RunOfVehicle, WhatIsWrongForOneServiceIsLeftToItToSay) {
  json vehicle = bench();
  vehicle["services"]["fusion"] = {{"engine", 3}};
  EXPECT_EQ(names(plan(vehicle)), (Words{"fusion", "monitor", "console", "gps_bridge", "imu_bridge"}));
}

TEST_F(RunOfVehicle, PeopleAreToldWhereToLook) {
  RunPlan made = plan(bench());
  EXPECT_EQ(console_address(made), "http://127.0.0.1:8420/");
  EXPECT_EQ(status_command(made), "fathom status");
  json vehicle = bench();
  vehicle["network"] = {{"domain", 7},
                        {"interfaces", {"192.168.2.10", "127.0.0.1"}},
                        {"peers", {"192.168.2.11"}},
                        {"security", {{"folder", "/etc/fathom/credentials"}}}};
  vehicle["services"]["console"] = {
      {"http", {{"address", "0.0.0.0"}}},
      {"tls", {{"certificate_file", "/etc/fathom/tls.pem"}, {"key_file", "/etc/fathom/tls.key"}}}};
  made = plan(vehicle);
  EXPECT_EQ(console_address(made), "https://127.0.0.1:8427/");
  EXPECT_EQ(status_command(made),
            "fathom status --domain 7 --interface 192.168.2.10 127.0.0.1 --peer 192.168.2.11 "
            "--security /etc/fathom/credentials");
}

}  // namespace
}  // namespace fathom::cli
