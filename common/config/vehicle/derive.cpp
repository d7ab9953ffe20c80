// What the file of a vehicle means for one service.

#include <algorithm>

#include "config/vehicle/catalogue.hpp"
#include "config/vehicle/sources.hpp"

namespace fathom::config {

using nlohmann::json;

namespace {

Sources read_sources(const std::string& vehicle_file) {
  Sources out{load_vehicle(vehicle_file), read_file(vehicle_file), vehicle_file, {}};
  for (std::size_t i = 0; i < out.config.instruments.size(); ++i) {
    const VehicleInstrument& one = out.config.instruments[i];
    if (!one.enabled) continue;
    const std::string key = "instruments." + std::to_string(i);
    Known known{&one, out.file.at("instruments").at(i), {Layer::vehicle, vehicle_file, key}, nullptr, {}};
    if (!one.model.empty()) {
      const std::string entry_file = catalogue_file(one.model, vehicle_file, key + ".model");
      known.model = read_file(entry_file);
      known.model_at = {Layer::catalogue, entry_file, ""};
    }
    out.instruments.push_back(std::move(known));
  }
  return out;
}

}  // namespace

Found find(const Known& known, const std::string& key, json standard) {
  if (known.own.contains(key)) return {known.own.at(key), known.at.child(key)};
  if (known.model.is_object() && known.model.contains(key))
    return {known.model.at(key), known.model_at.child(key)};
  return {std::move(standard), kStandard};
}

const codec::Protocol* protocol_of(const Known& known) {
  const json protocol = find(known, "protocol").value;
  return protocol.is_string() ? codec::find_protocol(protocol.get<std::string>()) : nullptr;
}

void put(Layers& out, const std::string& key, const Found& found) {
  if (!found.value.is_null()) out.overlay(key, found.value, found.origin);
}

std::string append(Layers& out, const std::string& array, std::size_t index, const Origin& origin) {
  if (index == 0) out.overlay(array, json::array(), origin);
  const std::string key = array + "." + std::to_string(index);
  out.grow(array);
  out.mark(key, origin);
  return key + ".";
}

const Known& inertial_unit(const Sources& vehicle) {
  return *std::find_if(vehicle.instruments.begin(), vehicle.instruments.end(),
                       [](const Known& known) { return known.config->kind == SourceKind::imu; });
}

LoadRequest with_vehicle(LoadRequest request, const std::string& vehicle_file, std::string_view service) {
  const Sources vehicle = read_sources(vehicle_file);
  Layers out(vehicle_file);
  const Origin top{Layer::vehicle, vehicle_file, ""};
  const Origin own = top.child("services").child(std::string(service));
  out.mark("", own);
  out.overlay("vehicle", vehicle.config.name, top.child("name"));
  out.overlay("clock.anchor_file", "/run/fathom/clock", kStandard);
  for (const auto& [section, key] : {std::pair{"bus", "network"}, {"log", "log"}, {"realtime", "realtime"}}) {
    if (vehicle.file.contains(key)) out.overlay(section, vehicle.file.at(key), top.child(key));
  }
  const auto roles = bridge_roles();
  if (std::find(roles.begin(), roles.end(), service) != roles.end()) {
    if (std::none_of(vehicle.instruments.begin(), vehicle.instruments.end(),
                     [&](const Known& known) { return known.config->role() == service; }) &&
        request.file.empty())
      throw ConfigError(vehicle_file, "instruments", "without any for " + std::string(service),
                        "an enabled one of a kind that " + std::string(service) + " reads");
    bridge_layers(vehicle, service, out);
  }
  if (service == "recorder") out.overlay("folder", "/var/lib/fathom/recordings", kStandard);
  if (service == "ros2_gateway") ros2_layers(vehicle, out);
  if (service == "fusion") fusion_layers(vehicle, request, out);
  if (service == "monitor") monitor_layers(vehicle, out);
  if (vehicle.file.contains("services") && vehicle.file.at("services").contains(service))
    out.overlay("", vehicle.file.at("services").at(std::string(service)), own);
  request.base = std::make_shared<const Layers>(std::move(out));
  return request;
}

}  // namespace fathom::config
