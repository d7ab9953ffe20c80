#include <filesystem>
#include <string>

#include "config/fusion/engine_schema.hpp"
#include "config/fusion/hydro_config.hpp"
#include "estimation/description/engine.hpp"

namespace fathom::config {

using estimation::EngineConfig;
using estimation::VehicleModelConfig;

/// What a sensor's entry leaves out is that of its kind.
void describe(Schema<estimation::SensorConfig>& s) {
  estimation::describe(s);
  s.defaults_by_choice(
      [](const std::string& kind) { return estimation::default_sensor(*kind_named(kind), ""); });
}

/// Coefficients from the file that is named, relative to the file that names it.
void load_value(const nlohmann::json& json, VehicleModelConfig& out,
                const Rules<VehicleModelConfig>& /*rules*/, const Place& place) {
  schema_of<VehicleModelConfig>().load(json, out, place);
  if (out.coefficients_file.empty()) return;
  const std::filesystem::path named = out.coefficients_file;
  out.coefficients =
      load_hydro_coefficients((std::filesystem::path(place.file).parent_path() / named).string());
}

namespace {

/// What its constraint cannot do without (AID-NHC-4). Said to be false, a group is left out all the same.
void add_groups_of_wheels(estimation::StateGroups& groups) {
  groups.accel_scale = groups.mount_angles = groups.mount_lever = true;
}

bool on_wheels(const nlohmann::json& engine) {
  static const nlohmann::json::json_pointer kEnabled("/constraints/non_holonomic/enabled");
  return engine.contains(kEnabled) && engine.at(kEnabled) == true;
}

}  // namespace

void describe(Schema<EngineConfig>& s) {
  estimation::describe(s);
  s.check_values([](const EngineConfig& config) { return config.complaint(); });
}

void load_value(const nlohmann::json& json, EngineConfig& out, const Rules<EngineConfig>& /*rules*/,
                const Place& place) {
  if (json.is_object() && json.contains("configuration") && json.at("configuration").is_string()) {
    static_cast<void>(
        estimation::named_state_groups(json.at("configuration").get<std::string>(), out.groups));
  }
  if (on_wheels(json)) add_groups_of_wheels(out.groups);
  schema_of<EngineConfig>().load(json, out, place);
}

}  // namespace fathom::config
