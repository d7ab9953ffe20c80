// What a vehicle means for the monitor: what has to be there.

#include <algorithm>

#include "config/vehicle/sources.hpp"

namespace fathom::config {

void monitor_layers(const Sources& vehicle, Layers& out) {
  const auto limit = [&](const std::string& key, const char* in_file, double value) {
    const bool said = vehicle.file.contains("limits") && vehicle.file.at("limits").contains(in_file);
    out.overlay(key, value,
                said ? Origin{Layer::vehicle, vehicle.name, std::string("limits.") + in_file} : kStandard);
  };
  limit("navigation.horizontal_95_limit_m", "horizontal_95_m", vehicle.config.limits.horizontal_95_m);
  limit("gps.limit_s", "gps_outage_s", vehicle.config.limits.gps_outage_s);
  limit("alignment.limit_s", "alignment_s", vehicle.config.limits.alignment_s);
  out.overlay("gps.forecast.limit", "horizontal", kStandard);
  out.overlay("journal.path", "/var/lib/fathom/alarms.jsonl", kStandard);
  put(out, "navigation.rate_hz", find(inertial_unit(vehicle), "rate_hz"));
  bool gps = false;
  std::size_t sensors = 0;
  std::vector<std::string> services;
  for (const Known& known : vehicle.instruments) {
    const VehicleInstrument& one = *known.config;
    gps = gps || one.kind == SourceKind::gps;
    if (!one.watched) continue;
    const std::string at = append(out, "sensors", sensors++, known.at);
    out.overlay(at + "name", one.name.str(), known.at.child("name"));
    out.overlay(at + "kind", std::string(to_string(one.kind)), known.at.child("kind"));
    put(out, at + "rate_hz", find(known, "rate_hz"));
    if (&known == &inertial_unit(vehicle)) out.overlay(at + "severity", "critical", kStandard);
    // Out of earshot is no fault.
    if (one.kind == SourceKind::usbl || one.kind == SourceKind::range) {
      out.overlay(at + "severity", "notice", kStandard);
      out.overlay(at + "missing_s", 90.0, kStandard);
    }
  }
  out.overlay("gps.expected", gps, {Layer::vehicle, vehicle.name, "instruments"});
  std::size_t expected = 0;
  const auto expect = [&](const std::string& name, bool critical, const Origin& origin) {
    if (std::find(services.begin(), services.end(), name) != services.end()) return;
    services.push_back(name);
    const std::string at = append(out, "services", expected++, origin);
    out.overlay(at + "name", name, origin);
    if (critical) out.overlay(at + "severity", "critical", kStandard);
  };
  // Without one that stands by there is navigation still.
  for (const FusionRole& role : vehicle.config.roles.fusion)
    expect(role.name.str(), &role == &vehicle.config.roles.fusion.front(),
           {Layer::vehicle, vehicle.name, "roles.fusion"});
  for (const Known& known : vehicle.instruments)
    expect(std::string(known.config->role()), known.config->kind == SourceKind::imu, known.at.child("kind"));
  for (const std::string& name : vehicle.config.roles.expected)
    expect(name, false, {Layer::vehicle, vehicle.name, "roles.expected"});
}

}  // namespace fathom::config
