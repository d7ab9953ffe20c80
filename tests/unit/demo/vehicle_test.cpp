// The file of a simulated vehicle gives its bridges the same as the scenario's overrides of their own files.
#include "demo/vehicle.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "config/registry.hpp"
#include "config/scenario/scenario_config.hpp"
#include "config/scenario/scenario_wiring.hpp"
#include "config/vehicle/vehicle_config.hpp"
#include "support/paths.hpp"

namespace fathom::demo {
namespace {

using nlohmann::json;

const std::string kConfig = test::source_dir() + "/deploy/config";

class DemoVehicle : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(::testing::TempDir()) / ("demo_vehicle_" + std::string(GetParam()));
    std::filesystem::create_directories(folder);
    scenario = config::load_scenario({kConfig + "/scenarios/" + GetParam() + ".json", {}});
    const json network = {{"domain", 7}, {"interfaces", {"127.0.0.1"}}, {"peers", {"127.0.0.1"}}};
    const json common = json::parse(std::ifstream(kConfig + "/demo/vehicle.json"));
    json made = vehicle_of(common, scenario, wiring, {network, scenario.bridges, false, {"simulator"}});
    made.erase("$schema");
    vehicle = (folder / "vehicle.json").string();
    std::ofstream(vehicle) << made.dump(2);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  static json effective(const std::string& service, const config::LoadRequest& request) {
    for (const config::ConfigKind& kind : config::config_kinds()) {
      if (kind.name == service) return json::parse(kind.effective(request));
    }
    return nullptr;
  }

  std::filesystem::path folder;
  std::string vehicle;
  sim::Scenario scenario;
  config::Wiring wiring{"/run/devices", 100};
};

TEST_P(DemoVehicle, BridgesRunAsByTheirOwnFiles) {
  auto wired = config::service_overrides(scenario, wiring);
  for (const std::string& bridge : scenario.bridges) {
    SCOPED_TRACE(bridge);
    const std::string service = bridge + "_bridge";
    auto sets = wired[service];
    sets.emplace_back("bus.domain=7");
    std::vector<std::string> own;
    for (const auto& [key, value] : scenario.services[service]) own.push_back(key + "=" + value);
    EXPECT_EQ(effective(service, config::with_vehicle({"", own}, vehicle, service)),
              effective(service, {kConfig + "/" + service + ".json", sets}));
  }
}

TEST_P(DemoVehicle, FusionRunsAsByItsOwnFile) {
  std::vector<std::string> sets;
  for (const auto& [key, value] : scenario.services["fusion"])
    sets.push_back(key + "=" + (key.ends_with("coefficients_file") ? kConfig + "/" + value : value));
  const json now = effective("fusion", config::with_vehicle({"", sets}, vehicle, "fusion"));
  sets.push_back("engine.imu.nominal_rate_hz=" + json(scenario.sensors.of<ImuSample>().rate_hz).dump());
  const json before = effective("fusion", {kConfig + "/fusion.json", sets});
  for (const char* section : {"imu", "alignment", "groups", "states", "vehicle_model", "altimeter"})
    EXPECT_EQ(now["engine"][section], before["engine"][section]) << section;
  for (const json& sensor : now["engine"]["sensors"]) {
    if (!sensor["enabled"].get<bool>()) continue;
    const auto& all = before["engine"]["sensors"];
    EXPECT_NE(std::find(all.begin(), all.end(), sensor), all.end()) << sensor;
  }
  EXPECT_EQ(now["start"], before["start"]);
}

INSTANTIATE_TEST_SUITE_P(Scenarios, DemoVehicle,
                         ::testing::Values("survey", "air_drop", "flight", "rotating_arm", "dvl_loss",
                                           "beacons"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace fathom::demo
