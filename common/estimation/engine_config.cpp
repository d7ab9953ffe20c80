#include "estimation/engine_config.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "base/field_check.hpp"
#include "estimation/description/engine.hpp"
#include "estimation/filter/state_index.hpp"

namespace fathom::estimation {
namespace {

constexpr std::size_t kLongestName = 31;
constexpr std::size_t kMostSensors = 24;
constexpr std::size_t kMostLimits = 8;

constexpr std::array<StateConfiguration, 6> kConfigurations{{
    {"gps_ins15", {}},
    {"gps_ins24", {.accel_scale = true, .gyro_scale = true, .gps_position_bias = true}},
    {"gps_ins36",
     {.accel_scale = true,
      .gyro_scale = true,
      .accel_misalignment = true,
      .gyro_misalignment = true,
      .gps_position_bias = true}},
    {"standard",
     {.dvl_scale = true,
      .dvl_misalignment = true,
      .current = true,
      .surface_altitude = true,
      .heading_bias = true,
      .gps_position_bias = true}},
    {"hybrid25",
     {.dvl_scale_xyz = true,
      .depth_bias = true,
      .heading_bias = true,
      .usbl_bias = true,
      .usbl_misalignment = true}},
    {"full",
     {.accel_scale = true,
      .gyro_scale = true,
      .accel_misalignment = true,
      .gyro_misalignment = true,
      .dvl_scale = true,
      .dvl_misalignment = true,
      .current = true,
      .surface_altitude = true,
      .heading_bias = true,
      .heading_deviation = true,
      .usbl_bias = true,
      .usbl_misalignment = true,
      .gps_position_bias = true}},
}};

using Found = std::optional<Complaint>;

std::string number(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

Found complaint_about_name(const std::string& key, const std::string& name) {
  if (!name.empty() && name.size() <= kLongestName) return {};
  return Complaint{key, name, "1 to 31 characters"};
}

Found complaint_about_count(const std::string& key, std::size_t count, std::size_t most) {
  if (count <= most) return {};
  return Complaint{key, std::to_string(count), "at most " + std::to_string(most)};
}

Found complaint_about_groups(const EngineConfig& config) {
  const StateGroups& groups = config.groups;
  if (groups.dvl_scale && groups.dvl_scale_xyz)
    return Complaint{"groups.dvl_scale_xyz", "true", "false where dvl_scale is true"};
  const int estimated = state_count(groups);
  const int considered = state_count(config.considered()) - state_count({});
  if (estimated + considered <= kMaxStates) return {};
  if (considered == 0)
    return Complaint{"groups", std::to_string(estimated) + " states",
                     "at most " + std::to_string(kMaxStates) + " together"};
  return Complaint{"groups",
                   std::to_string(estimated) + " states and " + std::to_string(considered) + " considered",
                   "at most " + std::to_string(kMaxStates) + " together; left_out noise considers none"};
}

Found complaint_about_sensors(const std::vector<SensorConfig>& sensors) {
  std::set<std::pair<std::string, bool>> names;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const SensorConfig& one = sensors[i];
    // One controller may tell shaft speed and fins under one name.
    if (!names.emplace(one.sensor, one.kind == SourceKind::fins).second)
      return Complaint{"sensors." + std::to_string(i) + ".sensor", one.sensor,
                       "each name once, but that fins may share one"};
  }
  return {};
}

Found complaint_about_vehicle_model(const VehicleModelConfig& model, const StateGroups& groups) {
  if (!model.enabled) return {};
  if (auto found = model.coefficients.complaint()) {
    found->key = "vehicle_model.coefficients." + found->key;
    return found;
  }
  constexpr const char* kNeeded = "true where vehicle_model is enabled";
  if (!groups.current) return Complaint{"groups.current", "false", kNeeded};
  if (!groups.model_bias) return Complaint{"groups.model_bias", "false", kNeeded};
  return {};
}

Found complaint_about_air_drop(const DropConfig& drop) {
  for (const auto& [key, value] : {std::pair{"slip_per_turn_m", drop.slip_per_turn_m},
                                   {"trim_m2_s2", drop.trim_m2_s2},
                                   {"flow_lag_m", drop.flow_lag_m},
                                   {"surge_tau_s", drop.surge_tau_s},
                                   {"speed_lag_s", drop.speed_lag_s}}) {
    if (!known(value))
      return Complaint{std::string("air_drop.") + key, "missing",
                       "the vehicle's own value where the start is an air drop"};
  }
  return {};
}

Found complaint_about_times(const EngineConfig& config) {
  if (config.imu.lost_gap_s < config.imu.max_gap_s)
    return Complaint{"imu.lost_gap_s", number(config.imu.lost_gap_s),
                     "at least imu.max_gap_s, which is " + number(config.imu.max_gap_s)};
  if (config.snapshot_interval_s > config.horizon_s)
    return Complaint{"snapshot_interval_s", number(config.snapshot_interval_s),
                     "at most horizon_s, which is " + number(config.horizon_s)};
  return {};
}

}  // namespace

std::span<const StateConfiguration> state_configurations() {
  return kConfigurations;
}

bool named_state_groups(const std::string& name, StateGroups& groups) {
  for (const StateConfiguration& one : kConfigurations) {
    if (name != one.name) continue;
    groups = one.groups;
    return true;
  }
  return false;
}

EngineConfig::EngineConfig() {
  (void)named_state_groups(configuration, groups);
  forecast_limits = {{"horizontal_10m", 10.0}, {"horizontal_100m", 100.0}, {"heading_3deg", 0.0524}};
}

double EngineConfig::aligned_tilt_sigma_rad() const {
  return std::max(alignment.aligned_tilt_sigma_rad,
                  2.0 * std::hypot(imu.accel_scale_sigma, imu.accel_misalignment_sigma_rad));
}

bool EngineConfig::remembers() const {
  return late_fix_memory_s > 0.0 && std::any_of(sensors.begin(), sensors.end(), [](const SensorConfig& one) {
           return one.kind == SourceKind::fix;
         });
}

std::optional<Complaint> EngineConfig::complaint() const {
  if (auto found = field_check<EngineConfig>().complaint(*this)) return found;
  if (auto found = complaint_about_name("vehicle", vehicle)) return found;
  if (auto found = complaint_about_name("sensor", sensor)) return found;
  if (auto found = complaint_about_groups(*this)) return found;
  if (auto found = complaint_about_count("sensors", sensors.size(), kMostSensors)) return found;
  if (auto found = complaint_about_sensors(sensors)) return found;
  if (auto found = complaint_about_vehicle_model(vehicle_model, groups)) return found;
  if (auto found = complaint_about_times(*this)) return found;
  if (alignment.mode == StartMode::air_drop) {
    if (auto found = complaint_about_air_drop(air_drop)) return found;
  }
  return complaint_about_count("forecast_limits", forecast_limits.size(), kMostLimits);
}

std::string EngineConfig::validate() const {
  const auto found = complaint();
  return found ? found->text() : "";
}

}  // namespace fathom::estimation
