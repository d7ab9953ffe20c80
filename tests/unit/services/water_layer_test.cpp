// A PD0 DVL loses the bottom for 300 s in a current; its water layer goes on. From the bytes of the
// instruments to the navigation state, with the bridges and fusion as they are shipped.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/study/device_path.hpp"
#include "config/fusion/fusion_config.hpp"
#include "config/scenario/scenario_config.hpp"
#include "config/scenario/scenario_wiring.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/wgs84.hpp"
#include "samples/nav_detail.hpp"
#include "sim/simulation.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using nlohmann::json;

constexpr TimeNs kEpoch_ns = 1'700'000'000 * kNsPerSecond;
constexpr double kLost_s = 500.0;
constexpr double kFound_s = 800.0;
constexpr double kCurrentN_m_s = 0.32;
constexpr double kCurrentE_m_s = -0.24;
const std::string kConfig = source_dir() + "/deploy/config";

sim::Scenario scenario_with(bool water_layer) {
  json scenario = json::parse(std::ifstream(kConfig + "/scenarios/survey.json"));
  scenario.erase("$schema");
  scenario["duration_s"] = kFound_s + 10.0;
  scenario["environment"]["current_N_m_s"] = {kCurrentN_m_s, kCurrentE_m_s};
  scenario["environment"]["water_depth_m"] = 60;
  scenario["environment"]["bottom_slope_N"] = 0.0;
  scenario["mission"] = json::array({{{"at_s", 0}, {"speed_m_s", 0}, {"heading_deg", 35}, {"depth_m", 0}},
                                     {{"at_s", 20}, {"speed_m_s", 2.0}, {"heading_deg", 60}},
                                     {{"at_s", 60}, {"heading_deg", 330}},
                                     {{"at_s", 100}, {"depth_m", 15}},
                                     {{"at_s", 250}, {"heading_deg", 90}},
                                     {{"at_s", 400}, {"heading_deg", 200}},
                                     {{"at_s", 650}, {"heading_deg", 290}}});
  scenario["sensors"]["usbl"]["enabled"] = false;
  scenario["bridges"] = {"imu", "gps", "dvl", "depth", "heading", "actuator"};
  json& dvl = scenario["sensors"]["dvl"];
  dvl["dropouts"] = json::array();
  dvl["bottom_lost"] = {{{"from_s", kLost_s}, {"to_s", kFound_s}}};
  dvl["water_layer"] = water_layer;
  const TemporaryFolder folder;
  const std::string file = folder / "scenario.json";
  std::ofstream(file) << scenario.dump();
  return config::load_scenario({file, {}});
}

struct Result {
  double current_error_m_s = kUnknown;  ///< as the bottom is lost
  double drift_m = kUnknown;            ///< from then until it is found
  double sigma_m = kUnknown;            ///< horizontal, at the end
  int water_used = 0;
  int water_duplicates = 0;
};

Result navigate(const sim::Scenario& scenario, std::uint64_t seed) {
  const auto fusion = config::load_service_config<config::FusionConfig>({kConfig + "/fusion.json", {}}).value;
  estimation::FusionEngine engine(config::engine_config(fusion));
  sim::Simulation simulation(scenario, {kEpoch_ns, seed, "auv"});
  cli::DevicePath devices(scenario, kConfig, kEpoch_ns);
  Result out;
  std::vector<TimeNs> layers;  // instants of the water layer
  Eigen::Vector3d error_then = Eigen::Vector3d::Zero();
  const auto error_now = [&] {
    const NavState& state = engine.nav_state();
    const Truth truth = simulation.truth();
    return geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                             {state.latitude_rad, state.longitude_rad, state.altitude_m});
  };
  std::vector<sim::Measurement> waiting;
  std::vector<sim::Measurement> fresh;
  bool lost = false;
  while (simulation.time_s() < kFound_s - 1e-6) {
    fresh.clear();
    simulation.advance(fresh);
    waiting.insert(waiting.end(), fresh.begin(), fresh.end());
    std::stable_sort(waiting.begin(), waiting.end(), [](const auto& a, const auto& b) {
      return header_of(a).received_ns < header_of(b).received_ns;
    });
    const auto now_ns = simulation.truth().header.stamp_ns;
    std::size_t arrived = 0;
    for (; arrived < waiting.size() && header_of(waiting[arrived]).received_ns <= now_ns; ++arrived) {
      devices.send(waiting[arrived], [&](const sim::Measurement& one) {
        std::visit([&](const auto& sample) { engine.add(sample); }, one);
        const auto* dvl = std::get_if<DvlSample>(&one);
        if (dvl != nullptr && dvl->mode == DvlMode::water) layers.push_back(dvl->header.stamp_ns);
      });
    }
    waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(arrived));
    for (Verdict verdict; engine.next_verdict(verdict);) {
      if (verdict.source != SourceKind::dvl || !verdict.is_final) continue;
      out.water_duplicates += verdict.kind == VerdictKind::duplicate ? 1 : 0;
      // Nothing but the layer can be used while the bottom is lost.
      const double at_s = to_seconds(verdict.header.stamp_ns - kEpoch_ns);
      if (at_s > kLost_s && verdict.kind == VerdictKind::used) ++out.water_used;
    }
    if (lost || simulation.time_s() < kLost_s) continue;
    lost = true;
    error_then = error_now();
    NavDetail detail;
    engine.fill(detail);
    double north = kUnknown;
    double east = kUnknown;
    for (std::uint32_t i = 0; i < detail.count; ++i) {
      if (detail.states[i].name == Name("current_north_m_s")) north = detail.states[i].value;
      if (detail.states[i].name == Name("current_east_m_s")) east = detail.states[i].value;
    }
    out.current_error_m_s = std::hypot(north - kCurrentN_m_s, east - kCurrentE_m_s);
  }
  out.drift_m = (error_now() - error_then).head<2>().norm();
  const auto& p = engine.nav_state().position_covariance_N_m2;
  out.sigma_m = std::sqrt(p[0] + p[4]);
  return out;
}

TEST(WaterLayer, CarriesOnWhereTheBottomIsLost) {
  const sim::Scenario with = scenario_with(true);
  const sim::Scenario without = scenario_with(false);
  double drift_with_m = 0.0;
  double drift_without_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const Result layer = navigate(with, seed);
    const Result bottom = navigate(without, seed);
    EXPECT_LT(layer.current_error_m_s, 0.03);
    EXPECT_GT(layer.water_used, 1000) << "five a second for 300 s";
    EXPECT_EQ(layer.water_duplicates, 0);
    EXPECT_EQ(bottom.water_used, 0);
    EXPECT_LT(layer.drift_m, 3.0 * layer.sigma_m);
    drift_with_m += layer.drift_m;
    drift_without_m += bottom.drift_m;
    std::printf("seed %d: current known to %.3f m/s, drift in 300 s %.1f m, without the layer %.1f m\n",
                static_cast<int>(seed), layer.current_error_m_s, layer.drift_m, bottom.drift_m);
  }
  EXPECT_LT(drift_with_m, drift_without_m / 3.0);
}

}  // namespace
}  // namespace fathom::test
