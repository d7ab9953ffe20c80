// What a vehicle means for fusion.

#include <algorithm>
#include <numbers>
#include <tuple>
#include <utility>

#include "config/vehicle/sources.hpp"

namespace fathom::config {
namespace {

using nlohmann::json;

/// From the inertial unit to an instrument.
json lever_of(const Known& unit, const Known& known) {
  json lever = json::array();
  for (std::size_t i = 0; i < 3; ++i)
    lever.push_back(known.config->position_m[i] - unit.config->position_m[i]);
  return lever;
}

/// The further keys of the model, and of the vehicle. What the vehicle says elsewhere stands between them.
void add_model_keys(Layers& out, const std::string& at, const Known& known) {
  if (known.model.contains("fusion"))
    out.overlay(at, known.model.at("fusion"), known.model_at.child("fusion"));
}
void add_own_keys(Layers& out, const std::string& at, const Known& known) {
  if (known.own.contains("fusion")) out.overlay(at, known.own.at("fusion"), known.at.child("fusion"));
}

/// The starting uncertainties that the model brings. Of several instruments that bring the same the larger
/// holds.
void add_model_states(Layers& out, const Known& known) {
  if (!known.model.contains("states")) return;
  const json so_far = out.value().at("engine").value("states", json::object());
  json states = known.model.at("states");
  for (const auto& [key, value] : so_far.items()) {
    if (states.contains(key) && states.at(key) <= value) states.erase(key);
  }
  out.overlay("engine.states", states, known.model_at.child("states"));
}

/// What the protocol says of the instrument's samples.
void add_traits(Layers& out, const std::string& at, const Known& known) {
  const codec::Protocol* speaks = protocol_of(known);
  if (known.config->kind == SourceKind::heading && speaks != nullptr && speaks->traits.heading_by_antennas)
    out.overlay(at + "two_antenna", true, kStandard);
}

/// What an inertial unit is taken for where nobody says better: the engine's own default is that of a
/// tactical unit, which few are. deploy/README.md has the figures of the classes.
void add_class_of_unit(Layers& out, bool has_model) {
  const Origin of_class{Layer::standard, "class of factory-calibrated MEMS modules", ""};
  json figures = {{"gyro_bias_sigma_deg_h", 180.0},      {"accel_bias_sigma_m_s2", 0.02942},
                  {"gyro_scale_sigma", 0.001},           {"accel_scale_sigma", 0.001},
                  {"gyro_misalignment_sigma_deg", 0.05}, {"accel_misalignment_sigma_deg", 0.05}};
  // A model says its noise as far as it is known, and is seldom noisier than the default where it is not.
  if (!has_model) {
    figures["angle_random_walk_deg_sqrt_h"] = 0.3;
    figures["velocity_random_walk_m_s_sqrt_h"] = 0.08;
    figures["gyro_bias_instability_deg_h"] = 10.0;
  }
  out.overlay("engine.imu", figures, of_class);
}

/// A bias is at least as uncertain when it is switched on as it wanders afterwards, where the latter is said
/// more particularly.
void widen_turn_on_bias(Layers& out) {
  const json imu = out.value().at("engine").at("imu");
  for (const auto& [sigma, instability] : {std::pair{"gyro_bias_sigma_deg_h", "gyro_bias_instability_deg_h"},
                                           {"accel_bias_sigma_m_s2", "accel_bias_instability_m_s2"}}) {
    if (!imu.contains(instability) || !imu.at(instability).is_number() || !imu.at(sigma).is_number())
      continue;
    const Origin said = out.origin_of(std::string("engine.imu.") + instability);
    if (out.origin_of(std::string("engine.imu.") + sigma).layer >= said.layer) continue;
    if (imu.at(instability).get<double>() <= imu.at(sigma).get<double>()) continue;
    out.overlay(std::string("engine.imu.") + sigma, imu.at(instability), said);
  }
}

}  // namespace

void fusion_layers(const Sources& vehicle, const LoadRequest& request, Layers& out) {
  const Known& unit = inertial_unit(vehicle);
  out.overlay("engine", json::object(), kStandard);
  out.overlay("imu_sensor", unit.config->name.str(), unit.at.child("name"));
  out.mark("engine.imu", unit.at.child("fusion"));
  add_class_of_unit(out, unit.model.is_object());
  add_model_keys(out, "engine.imu", unit);
  put(out, "engine.imu.nominal_rate_hz", find(unit, "rate_hz"));
  put(out, "engine.imu.mounting_rpy_deg", find(unit, "mounting_rpy_deg"));
  add_own_keys(out, "engine.imu", unit);
  widen_turn_on_bias(out);
  out.overlay("engine.sensors", json::array(), {Layer::vehicle, vehicle.name, "instruments"});
  std::size_t count = 0;
  for (const Known& known : vehicle.instruments) {
    const VehicleInstrument& one = *known.config;
    add_model_states(out, known);
    const bool placed = known.own.contains("position_m");
    if (one.kind == SourceKind::altimeter) {
      add_model_keys(out, "engine.altimeter", known);
      out.overlay("engine.altimeter.sensor", one.name.str(), known.at.child("name"));
      if (placed)
        out.overlay("engine.altimeter.lever_B_m", lever_of(unit, known), known.at.child("position_m"));
      add_own_keys(out, "engine.altimeter", known);
    }
    bool aids = false;
    for_each_aiding_kind([&](auto kind) { aids = aids || kind.kSource == one.kind; });
    if (!aids) continue;
    const std::string at = append(out, "engine.sensors", count++, known.at.child("fusion"));
    add_traits(out, at, known);
    add_model_keys(out, at.substr(0, at.size() - 1), known);
    out.overlay(at + "sensor", one.name.str(), known.at.child("name"));
    out.overlay(at + "kind", std::string(to_string(one.kind)), known.at.child("kind"));
    if (placed) out.overlay(at + "lever_B_m", lever_of(unit, known), known.at.child("position_m"));
    put(out, at + "mounting_rpy_deg", find(known, "mounting_rpy_deg"));
    add_own_keys(out, at.substr(0, at.size() - 1), known);
  }
  // A person may always say where the vehicle was.
  const auto& known = vehicle.instruments;
  if (std::none_of(known.begin(), known.end(),
                   [](const Known& one) { return one.config->name == Name("operator"); })) {
    const std::string at = append(out, "engine.sensors", count++, kStandard);
    out.overlay(at + "sensor", "operator", kStandard);
    out.overlay(at + "kind", std::string(to_string(SourceKind::fix)), kStandard);
  }
  const VehicleLimits& limit = vehicle.config.limits;
  std::size_t limits = 0;
  for (const auto& [name, in_file, value] :
       {std::tuple{"horizontal", "horizontal_95_m", limit.horizontal_95_m},
        {"heading", "heading_deg", limit.heading_deg * std::numbers::pi / 180.0}}) {
    const std::string at = append(out, "engine.forecast_limits", limits++, kStandard);
    out.overlay(at + "name", name, kStandard);
    const bool said = vehicle.file.contains("limits") && vehicle.file.at("limits").contains(in_file);
    out.overlay(at + "limit", value,
                said ? Origin{Layer::vehicle, vehicle.name, std::string("limits.") + in_file} : kStandard);
  }
  // Which of the fusion services this one is.
  std::string instance = vehicle.config.roles.fusion.front().name.str();
  for (const std::string& set : request.sets) {
    if (set.starts_with("instance=")) instance = set.substr(9);
  }
  const bool said = vehicle.file.contains("roles") && vehicle.file.at("roles").contains("fusion");
  for (std::size_t i = 0; i < vehicle.config.roles.fusion.size(); ++i) {
    const FusionRole& role = vehicle.config.roles.fusion[i];
    if (role.name.str() != instance) continue;
    const Origin at =
        said ? Origin{Layer::vehicle, vehicle.name, "roles.fusion." + std::to_string(i)} : kStandard;
    out.overlay("instance", instance, at.child("name"));
    out.overlay("ownership_strength", role.strength, at.child("strength"));
  }
  out.overlay("checkpoint.path", "/run/fathom/" + instance + ".checkpoint", kStandard);
  if (vehicle.config.roles.fusion.size() > 1)
    out.overlay("standby.enabled", true, {Layer::vehicle, vehicle.name, "roles.fusion"});
}

}  // namespace fathom::config
