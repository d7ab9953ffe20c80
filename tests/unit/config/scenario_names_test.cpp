// Fusion listens to instruments by name: every scenario's bridges must publish under the names that its
// fusion knows.
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "config/bridge/bridge_config.hpp"
#include "config/fusion/fusion_config.hpp"
#include "config/scenario/scenario_config.hpp"
#include "config/scenario/scenario_wiring.hpp"
#include "config/service_config.hpp"
#include "support/paths.hpp"

namespace fathom::config {
namespace {

const std::string kConfig = test::source_dir() + "/deploy/config/";

using Overrides = std::map<std::string, std::vector<std::string>>;

template <class Bridge>
std::set<std::string> names(const std::string& service, Overrides& overrides) {
  std::set<std::string> out;
  const auto loaded = load_service_config<Bridge>({kConfig + service + ".json", overrides[service]});
  for (const SensorPlan& plan : sensor_plans(loaded.value)) out.insert(plan.sensor.name.str());
  return out;
}

// Names by which each kind of aiding arrives, for the bridges that the scenario runs.
std::map<SourceKind, std::set<std::string>> published(const sim::Scenario& scenario, Overrides& overrides) {
  std::map<SourceKind, std::set<std::string>> out;
  for (const std::string& bridge : scenario.bridges) {
    if (bridge == "gps") out[SourceKind::gps] = names<GpsBridgeConfig>("gps_bridge", overrides);
    if (bridge == "dvl") out[SourceKind::dvl] = names<DvlBridgeConfig>("dvl_bridge", overrides);
    if (bridge == "depth") out[SourceKind::depth] = names<DepthBridgeConfig>("depth_bridge", overrides);
    if (bridge == "heading")
      out[SourceKind::heading] = names<HeadingBridgeConfig>("heading_bridge", overrides);
    if (bridge == "usbl") out[SourceKind::usbl] = names<UsblBridgeConfig>("usbl_bridge", overrides);
    if (bridge == "actuator")
      out[SourceKind::propulsion] = names<ActuatorBridgeConfig>("actuator_bridge", overrides);
    if (bridge == "air_data")
      out[SourceKind::airspeed] = names<AirDataBridgeConfig>("air_data_bridge", overrides);
  }
  return out;
}

TEST(ScenarioNames, FusionKnowsEveryInstrumentThatItIsSetToUse) {
  for (const std::string& name : scenario_names(kConfig + "scenarios")) {
    SCOPED_TRACE(name);
    const sim::Scenario scenario = load_scenario({scenario_file(name, kConfig + "scenarios"), {}});
    auto overrides = service_overrides(scenario, {});
    const auto fusion = load_service_config<FusionConfig>({kConfig + "fusion.json", overrides["fusion"]});
    const auto heard = published(scenario, overrides);
    for (const auto& sensor : fusion.value.engine.sensors) {
      const auto at = heard.find(sensor.kind);
      if (!sensor.enabled || at == heard.end()) continue;
      EXPECT_EQ(at->second.count(sensor.sensor), 1U)
          << "fusion listens to " << sensor.sensor << ", which no bridge of the scenario publishes";
    }
  }
}

}  // namespace
}  // namespace fathom::config
