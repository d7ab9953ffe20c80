#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "config/scenario/scenario_config.hpp"
#include "config/scenario/scenario_wiring.hpp"
#include "config/scenario/simulator_config.hpp"
#include "sim/device_encoder.hpp"
#include "sim/simulation.hpp"
#include "support/paths.hpp"

namespace fathom::config {
namespace {

const std::string kFolder = test::source_dir() + "/deploy/config/scenarios";

sim::Scenario shipped(const std::string& name, const std::vector<std::string>& sets = {}) {
  return load_scenario({scenario_file(name, kFolder), sets});
}

struct Timeline {
  double deepest_m = 0.0;
  double fastest_m_s = 0.0;
  std::vector<std::pair<double, double>> gps_outages;  ///< longer than 5 s
  std::map<std::string, int> samples;
  double dvl_silent_s = 0.0;  ///< longest time without a bottom velocity
};

Timeline timeline_of(const sim::Scenario& scenario, double duration_s) {
  sim::Simulation simulation(scenario, {});
  Timeline out;
  std::vector<sim::Measurement> measurements;
  double lost_s = -1.0;
  double dvl_s = 0.0;
  while (simulation.time_s() < duration_s - 1e-9) {
    measurements.clear();
    simulation.advance(measurements);
    const Truth truth = simulation.truth();
    const double t_s = simulation.time_s();
    out.deepest_m = std::max(out.deepest_m, scenario.environment.surface_altitude_m - truth.altitude_m);
    out.fastest_m_s = std::max(out.fastest_m_s, std::hypot(truth.velocity_N_m_s[0], truth.velocity_N_m_s[1]));
    if (!truth.gps_available && lost_s < 0.0) lost_s = t_s;
    if (truth.gps_available && lost_s >= 0.0) {
      if (t_s - lost_s > 5.0) out.gps_outages.emplace_back(lost_s, t_s);
      lost_s = -1.0;
    }
    for (const auto& m : measurements) {
      ++out.samples[header_of(m).sensor.str()];
      const auto* dvl = std::get_if<DvlSample>(&m);
      if (dvl != nullptr && known(dvl->velocity_D_m_s[0])) {
        out.dvl_silent_s = std::max(out.dvl_silent_s, t_s - dvl_s);
        dvl_s = t_s;
      }
    }
  }
  return out;
}

TEST(Scenarios, TheSixAreThere) {
  const auto names = scenario_names(kFolder);
  for (const char* name : {"survey", "air_drop", "flight", "rotating_arm", "dvl_loss", "beacons"}) {
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  }
}

TEST(Scenarios, EachLoadsSpeaksItsProtocolsAndNamesItsBridges) {
  for (const auto& name : scenario_names(kFolder)) {
    const sim::Scenario scenario = shipped(name);
    EXPECT_EQ(scenario.name, name);
    EXPECT_FALSE(scenario.mission.empty()) << name;
    for (const char* kind : {"imu", "gps", "dvl", "depth", "heading", "usbl", "propulsion", "fins",
                             "airspeed", "altimeter", "range", "fix"}) {
      const auto* sensor = sim::find_sensor(scenario.sensors, kind);
      if (!sensor->enabled) continue;
      EXPECT_TRUE(sim::can_encode(kind, sensor->protocol)) << name << " " << kind;
      std::string bridge = kind;
      if (bridge == "propulsion" || bridge == "fins") bridge = "actuator";
      if (bridge == "airspeed") bridge = "air_data";
      EXPECT_NE(std::find(scenario.bridges.begin(), scenario.bridges.end(), bridge), scenario.bridges.end())
          << name << " " << kind;
    }
  }
}

TEST(Scenarios, SurveyKeepsItsTimetable) {
  const sim::Scenario scenario = shipped("survey");
  const Timeline seen = timeline_of(scenario, scenario.duration_s);
  ASSERT_GE(seen.gps_outages.size(), 2U);
  EXPECT_NEAR(seen.gps_outages[0].first, 37.0, 3.0);
  EXPECT_LT(seen.gps_outages[0].second, 70.0);
  EXPECT_NEAR(seen.deepest_m, 15.0, 1.5);
  EXPECT_NEAR(seen.dvl_silent_s, 25.0, 1.0);
  // A run of 90 s shows an outage of each as well.
  const Timeline short_run = timeline_of(scenario, 90.0);
  EXPECT_EQ(short_run.gps_outages.size(), 1U);
  EXPECT_NEAR(short_run.dvl_silent_s, 8.0, 1.0);
  EXPECT_GT(seen.samples.at("usbl"), 50);
  EXPECT_GE(static_cast<int>(seen.gps_outages.size()), scenario.limits.gps_outages_at_least);
}

TEST(Scenarios, DvlLossLosesTheDvlForFiveMinutes) {
  const sim::Scenario scenario = shipped("dvl_loss");
  const Timeline seen = timeline_of(scenario, scenario.duration_s);
  EXPECT_NEAR(seen.dvl_silent_s, 300.0, 1.0);
  EXPECT_GT(seen.samples.at("propulsion"), 2000);
  EXPECT_GT(seen.samples.at("fins"), 2000);
  EXPECT_NEAR(seen.deepest_m, 12.5, 1.0);
  EXPECT_GE(static_cast<int>(seen.gps_outages.size()), scenario.limits.gps_outages_at_least);
}

TEST(Scenarios, AirDropReachesItsDepth) {
  const sim::Scenario scenario = shipped("air_drop");
  const Timeline seen = timeline_of(scenario, scenario.duration_s);
  EXPECT_NEAR(seen.deepest_m, 80.0, 1.5);
  EXPECT_NEAR(seen.fastest_m_s, 61.7, 4.0);  // the release is drawn
  EXPECT_EQ(seen.samples.count("gps"), 0U);
}

TEST(Scenarios, FlightHasItsOutages) {
  const sim::Scenario scenario = shipped("flight");
  const Timeline seen = timeline_of(scenario, scenario.duration_s);
  ASSERT_EQ(seen.gps_outages.size(), 2U);
  EXPECT_NEAR(seen.gps_outages[0].second - seen.gps_outages[0].first, 10.5, 0.1);
  EXPECT_NEAR(seen.gps_outages[1].second - seen.gps_outages[1].first, 20.5, 0.1);
  EXPECT_GT(seen.samples.at("airspeed"), 2000);
}

TEST(Scenarios, RotatingArmReachesThreeMetresPerSecond) {
  const sim::Scenario scenario = shipped("rotating_arm");
  const Timeline seen = timeline_of(scenario, scenario.duration_s);
  EXPECT_NEAR(seen.fastest_m_s, 3.0, 0.01);
  EXPECT_NEAR(seen.deepest_m, 1.0, 1e-3);
}

TEST(Scenarios, MistakesAreNamedWithFileKeyAndExpectation) {
  const auto message = [](const std::vector<std::string>& sets) -> std::string {
    try {
      (void)shipped("survey", sets);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({"sensors.gps.rate=2"}).find("sensors.gps.rate"), std::string::npos);
  EXPECT_NE(message({"sensors.dvl.beam_angle_deg=200"}).find("5 to 60"), std::string::npos);
  EXPECT_NE(message({"sensors.imu.enabled=false"}).find("sets the pace"), std::string::npos);
  EXPECT_NE(message({"vehicle.kind=boat"}).find("auv, air_drop, aircraft, rotating_arm"), std::string::npos);
  EXPECT_NE(message({R"(sensors.gps.link={"type":"udp"})"}).find("1 to 65535"), std::string::npos);
  EXPECT_NE(message({R"(mission=[{"at_s":5},{"at_s":1}])"}).find("order of at_s"), std::string::npos);
  try {
    (void)scenario_file("no_such", kFolder);
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("survey"), std::string::npos);
  }
}

TEST(Scenarios, WiringPointsEachBridgeAtItsDevice) {
  const sim::Scenario scenario = shipped("survey");
  auto sets = service_overrides(scenario, {"/run/devices", 100});
  ASSERT_EQ(sets.count("imu_bridge"), 1U);
  EXPECT_NE(sets["imu_bridge"][0].find("/run/devices/imu"), std::string::npos);
  EXPECT_NE(sets["dvl_bridge"][0].find("17102"), std::string::npos);
  EXPECT_NE(sets["dvl_bridge"][0].find("tcp_client"), std::string::npos);
  EXPECT_EQ(sets["gps_bridge"][1], "sensors.0.protocol=nmea0183");
  EXPECT_EQ(service_overrides(shipped("flight"), {}).count("dvl_bridge"), 0U);
}

TEST(Scenarios, WhatAFrameSaysOfItsAgeIsNoLatencyOfItsBridge) {
  sim::SensorCommon sensor;
  sensor.latency_s = 0.6;
  sensor.protocol = "fix_text";
  EXPECT_EQ(latency_of(sensor, false), 0.0);  // its UTC
  sensor.protocol = "micromodem";             // the way from the device
  EXPECT_EQ(latency_of(sensor, false), 0.6);
  sensor.protocol = "s2c";
  EXPECT_EQ(latency_of(sensor, false), 0.0);
}

TEST(Scenarios, TheSimulatorsFileLoadsItsScenarioToo) {
  const std::string file = test::source_dir() + "/deploy/config/simulator.json";
  const auto loaded = load_service_config<SimulatorConfig>({file, {"scenario_dir=" + kFolder}});
  EXPECT_EQ(loaded.value.loaded.name, "survey");
  EXPECT_THROW(
      (void)load_service_config<SimulatorConfig>({file, {"scenario_dir=" + kFolder, "scenario=none"}}),
      ConfigError);
}

}  // namespace
}  // namespace fathom::config
