#include "config/scenario/scenario_config.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "base/units.hpp"
#include "config/scenario/scenario_schema.hpp"

namespace fathom::config {
namespace {

using Fault = std::pair<std::string, std::string>;

// The services of the table of kinds by the words of a scenario: roles without their ending.
std::vector<std::pair<std::string, std::string>> bridge_words() {
  std::vector<std::pair<std::string, std::string>> words;
  for (const std::string_view role : bridge_roles()) {
    const std::string word(role.substr(0, role.rfind("_bridge")));
    words.emplace_back(word, word);
  }
  return words;
}

}  // namespace

void describe(Schema<sim::EnvironmentConfig>& s) {
  using C = sim::EnvironmentConfig;
  s.field("surface_altitude_m", &C::surface_altitude_m, "mean water surface above the WGS-84 ellipsoid")
      .unit("m")
      .range(-120, 5000);
  s.field("geoid_separation_m", &C::geoid_separation_m, "geoid above the ellipsoid")
      .unit("m")
      .range(-120, 120);
  s.field("water_depth_m", &C::water_depth_m, "at the start").unit("m").range(0, 11000);
  s.field("bottom_slope_N", &C::bottom_slope_N, "metres deeper per metre north").range(-1, 1);
  s.field("magnetic_variation_deg", &C::magnetic_variation_rad, "east positive")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(-180, 180);
  s.field("current_N_m_s", &C::current_N_m_s, "velocity of the water: north, east").unit("m/s").range(-5, 5);
  s.field("current_spread_m_s", &C::current_spread_m_s,
          "1 sigma by which each component of the true current differs from that, drawn once a run")
      .unit("m/s")
      .range(0, 5);
  s.field("current_from_s", &C::current_from_s, "sheltered water before").unit("s").range(0, 1e6);
  s.field("current_ramp_s", &C::current_ramp_s, "the current grows over this time").unit("s").range(0.1, 1e6);
  s.field("wind_N_m_s", &C::wind_N_m_s, "velocity of the air: north, east").unit("m/s").range(-60, 60);
  s.field("air_temperature_offset_K", &C::air_temperature_offset_K, "warmer than the standard atmosphere")
      .unit("K")
      .range(-60, 40);
  s.field("turbulence_m_s", &C::turbulence_m_s, "1 sigma of the cross flow").unit("m/s").range(0, 20);
  s.field("turbulence_tau_s", &C::turbulence_tau_s, "its correlation time").unit("s").range(0.01, 1000);
  s.field("wave_height_m", &C::wave_height_m, "amplitude of the heave of the surface").unit("m").range(0, 5);
  s.field("wave_tilt_deg", &C::wave_tilt_rad, "amplitude of the slope of the surface")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0, 30);
  s.field("wave_period_s", &C::wave_period_s, "of the swell").unit("s").range(1, 30);
}

void describe(Schema<sim::StartSpread>& s) {
  using C = sim::StartSpread;
  s.field("position_N_m", &C::position_N_m, "1 sigma north, east, down").unit("m").range(0, 1e5);
  s.field("velocity_N_m_s", &C::velocity_N_m_s, "1 sigma north, east, down").unit("m/s").range(0, 100);
  s.field("attitude_deg", &C::attitude_rad, "1 sigma about north, east, down")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0, 60);
}

void describe(Schema<sim::StartConfig>& s) {
  using C = sim::StartConfig;
  s.field("latitude_deg", &C::latitude_rad, "of the body origin")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(-85, 85)
      .required();
  s.field("longitude_deg", &C::longitude_rad, "of the body origin")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(-180, 180)
      .required();
  s.field("depth_m", &C::depth_m, "below the mean surface; negative above").unit("m").range(-20000, 11000);
  s.field("speed_m_s", &C::speed_m_s, "ahead, through water or air").unit("m/s").range(0, 300);
  s.field("rpy_deg", &C::rpy_rad, "roll, pitch, yaw").unit("deg").scaled(kRadPerDeg).range(-180, 360);
  s.field("spread", &C::spread, "by which the true start differs from this one, drawn once a run");
}

void describe(Schema<sim::MissionStep>& s) {
  using C = sim::MissionStep;
  s.field("at_s", &C::at_s, "seconds since the start").unit("s").range(0, 1e6).required();
  s.field("speed_m_s", &C::speed_m_s, "through water or air; null or absent: as before")
      .unit("m/s")
      .range(0, 300)
      .nullable();
  s.field("heading_deg", &C::heading_rad, "to steer; null or absent: as before")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(-360, 360)
      .nullable();
  s.field("depth_m", &C::depth_m, "below the mean surface, negative above; null or absent: as before")
      .unit("m")
      .range(-20000, 11000)
      .nullable();
  s.field("bank_deg", &C::bank_rad, "aircraft: turn at this bank, 0 holds the heading")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(-60, 60)
      .nullable();
  s.field("dutch_roll_deg", &C::dutch_roll_rad, "aircraft: amplitude of a Dutch roll, 0 ends it")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0, 45)
      .nullable();
}

void describe(Schema<sim::ScenarioLimits>& s) {
  using C = sim::ScenarioLimits;
  s.field("horizontal_rms_m", &C::horizontal_rms_m, "of the position error")
      .unit("m")
      .range(0.01, 1e5)
      .required();
  s.field("horizontal_max_m", &C::horizontal_max_m, "of the position error; null: not asked for")
      .unit("m")
      .range(0.01, 1e6)
      .nullable();
  s.field("roll_pitch_rms_deg", &C::roll_pitch_rms_rad, "of each; null: not asked for")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0.001, 90)
      .nullable();
  s.field("yaw_rms_deg", &C::yaw_rms_rad, "null: not asked for")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0.001, 180)
      .nullable();
  s.field("aligned_within_s", &C::aligned_within_s, "of the start; null: not asked for")
      .unit("s")
      .range(0, 1e5)
      .nullable();
  s.field("score_from_s", &C::score_from_s, "earlier navigation is not scored").unit("s").range(0, 1e5);
  s.field("gps_outages_at_least", &C::gps_outages_at_least,
          "flagged by the monitor in a run of the default duration")
      .range(0, 1000);
  s.field(
      "expected_alarms", &C::expected_alarms,
      "names of the alarms that belong to the scenario; one that ends in * stands for all that begin so; any "
      "other alarm fails the run");
}

void describe(Schema<sim::Scenario>& s) {
  using C = sim::Scenario;
  s.field("name", &C::name, "of the scenario").name().required();
  s.field("description", &C::description, "one sentence").required();
  s.field("duration_s", &C::duration_s, "of a run where nothing else is said").unit("s").range(1, 1e6);
  s.field("environment", &C::environment, "water, air and ground");
  s.field("start", &C::start, "of the vehicle").required();
  s.field("vehicle", &C::vehicle, "its dynamics").required();
  s.field("mission", &C::mission, "orders to the autopilot, by time").required();
  s.field("sensors", &C::sensors, "instruments, their errors and their device output").required();
  s.field("bridges", &C::bridges, "bridges that a run of the whole system needs").words(bridge_words());
  s.field("services", &C::services,
          "overrides of the services' configurations: service, key, value as after --set");
  s.field("limits", &C::limits, "what a run has to reach").required();
  s.check([](const sim::Scenario& scenario) -> Fault {
    if (!scenario.sensors.of<ImuSample>().enabled)
      return {"sensors.imu.enabled", "true: the IMU sets the pace of the simulation"};
    for (std::size_t i = 1; i < scenario.mission.size(); ++i) {
      if (scenario.mission[i].at_s < scenario.mission[i - 1].at_s)
        return {"mission", "steps in the order of at_s"};
    }
    return {};
  });
}

sim::Scenario load_scenario(const LoadRequest& request) {
  return load<sim::Scenario>(request);
}

std::string scenario_directory() {
  namespace fs = std::filesystem;
  std::error_code error;
  if (const char* given = std::getenv("FATHOM_SCENARIO_DIR");
      given != nullptr && fs::is_directory(given, error)) {
    return given;
  }
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (error) return "";
  const fs::path folder = executable.parent_path();
  for (const auto* relative : {"../../deploy/config/scenarios", "../share/fathom/config/scenarios"}) {
    const fs::path candidate = (folder / relative).lexically_normal();
    if (fs::is_directory(candidate, error)) return candidate.string();
  }
  return "";
}

std::vector<std::string> scenario_names(const std::string& directory) {
  namespace fs = std::filesystem;
  std::vector<std::string> names;
  std::error_code error;
  const std::string folder = directory.empty() ? scenario_directory() : directory;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, error)) {
    if (!folder.empty() && entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string scenario_file(const std::string& name, const std::string& directory) {
  if (name.find('/') != std::string::npos || name.ends_with(".json")) return name;
  const std::string folder = directory.empty() ? scenario_directory() : directory;
  const auto names = scenario_names(folder);
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw ConfigError(folder.empty() ? "scenarios" : folder, "scenario", "\"" + name + "\"",
                      names.empty() ? "a scenario file; none was found here" : "one of " + list_words(names));
  }
  return (std::filesystem::path(folder) / (name + ".json")).string();
}

ConfigKind scenario_kind() {
  return make_kind<sim::Scenario>("scenario");
}

}  // namespace fathom::config
