#include "demo/vehicle.hpp"

#include <algorithm>
#include <numbers>
#include <set>

#include "samples/kinds.hpp"

namespace fathom::demo {
namespace {

using nlohmann::json;

// Of the weaker one of two fusion services, and of the stronger.
constexpr int kStrength = 10;
constexpr int kStandbyStrength = 5;

const sim::SensorCommon* sensor_of(const sim::Scenario& scenario, const std::string& word,
                                   bool& always_heard) {
  const sim::SensorCommon* found = nullptr;
  for_each_kind([&](auto kind) {
    if (word != kind.kWord) return;
    const auto& sensor = scenario.sensors.of<typename decltype(kind)::Sample>();
    if (sensor.enabled && !sensor.protocol.empty()) found = &sensor;
    always_heard = sensor.kAlwaysHeard;
  });
  return found;
}

std::string bridge_of(const std::string& word) {
  std::string role;
  for_each_kind([&](auto kind) {
    if (word == kind.kWord) role = kind.kRole;
  });
  return role.substr(0, role.rfind("_bridge"));
}

}  // namespace

json vehicle_of(json common, const sim::Scenario& scenario, const config::Wiring& wiring,
                const VehicleOfRun& run) {
  json instruments = json::array();
  std::set<std::string> ports;  // bridges whose port is said: kinds of one bridge share the first one's
  for (json& one : common.at("instruments")) {
    const std::string word = one.at("kind");
    const std::string bridge = bridge_of(word);
    bool always_heard = false;
    const sim::SensorCommon* sensor = sensor_of(scenario, word, always_heard);
    if (sensor == nullptr || std::find(run.bridges.begin(), run.bridges.end(), bridge) == run.bridges.end())
      continue;
    one["protocol"] = sensor->protocol;
    one["rate_hz"] = sensor->rate_hz;
    one["latency_s"] = config::latency_of(*sensor, word == KindOf<GpsSample>::kWord);
    one["watched"] = always_heard;
    if (ports.insert(bridge).second)
      one["port"] = config::port_of(*sensor, scenario, wiring);
    else
      one.erase("port");
    instruments.push_back(std::move(one));
  }
  common["instruments"] = std::move(instruments);
  common["network"] = run.network;
  common["latitude_deg"] = scenario.start.latitude_rad * 180.0 / std::numbers::pi;
  json fusion = json::array({{{"name", "fusion"}, {"strength", kStrength}}});
  if (run.standby) fusion.push_back({{"name", "fusion_standby"}, {"strength", kStandbyStrength}});
  common["roles"] = {{"fusion", std::move(fusion)}, {"expected", run.expected}};
  return common;
}

}  // namespace fathom::demo
