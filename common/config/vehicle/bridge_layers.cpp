// What a vehicle means for the bridge of some of its instruments.

#include <algorithm>

#include "config/vehicle/sources.hpp"

namespace fathom::config {
namespace {

using nlohmann::json;

/// The usual delay where nobody knows better.
double usual_latency_s(SourceKind kind) {
  return kind == SourceKind::imu ? 0.002 : 0.05;
}

/// Devices with UTC are trusted, counters are tracked, the rest is known by its latency.
std::string time_mode(SourceKind kind, const codec::Protocol* found) {
  const codec::Traits traits = found == nullptr ? codec::Traits{} : found->traits;
  if ((kind == SourceKind::gps && traits.fixes_have_utc) ||
      (kind == SourceKind::heading && traits.heading_by_antennas))
    return "device_utc";
  const codec::DeviceClock clock = found == nullptr ? codec::DeviceClock::none : found->clock;
  if (clock == codec::DeviceClock::counter) return "device_clock";
  if (clock == codec::DeviceClock::utc || kind == SourceKind::gps) return "device_utc";
  return "arrival";
}

void put_port(Layers& out, const Known& known, const std::string& at) {
  if (!known.own.contains("port")) return;
  const std::string type = known.own.at("port").value("type", "");
  if (known.model.is_object()) {
    if (type == "serial" && known.model.value("baud", 0) > 0)
      out.overlay(at + "source.baud", known.model.at("baud"), known.model_at.child("baud"));
    if (type == "tcp_client" && known.model.value("port", 0) > 0)
      out.overlay(at + "source.port", known.model.at("port"), known.model_at.child("port"));
  }
  out.overlay(at + "source", known.own.at("port"), known.at.child("port"));
}

}  // namespace

void bridge_layers(const Sources& vehicle, std::string_view role, Layers& out) {
  std::vector<std::string> names;
  for (const Known& known : vehicle.instruments) {
    const VehicleInstrument& one = *known.config;
    if (one.role() != role) continue;
    if (std::find(names.begin(), names.end(), one.name.str()) != names.end()) continue;  // shares the port
    const std::string at = append(out, "sensors", names.size(), known.at.child("bridge"));
    names.push_back(one.name.str());
    const std::string element = at.substr(0, at.size() - 1);
    if (known.model.contains("bridge"))
      out.overlay(element, known.model.at("bridge"), known.model_at.child("bridge"));
    for (const auto& [key, in_file] :
         {std::pair{"source", "port"}, {"protocol", "protocol"}, {"rate_hz", "rate_hz"}})
      out.mark(at + key, known.at.child(in_file));
    out.overlay(at + "name", one.name.str(), known.at.child("name"));
    put_port(out, known, at);
    put(out, at + "protocol", find(known, "protocol"));
    put(out, at + "rate_hz", find(known, "rate_hz"));
    const codec::Protocol* speaks = protocol_of(known);
    const std::string mode = time_mode(one.kind, speaks);
    out.overlay(at + "time.mode", mode, kStandard);
    put(out, at + (mode == "device_clock" ? "time.minimum_latency_s" : "time.latency_s"),
        find(known, "latency_s", usual_latency_s(one.kind)));
    if (one.kind == SourceKind::imu) {
      if (speaks != nullptr && speaks->traits.turns_axes) {
        out.overlay(at + "mounting.frame", "frd", kStandard);
      } else {
        put(out, at + "mounting.frame", find(known, "axes", "frd"));
      }
    }
    if (one.kind == SourceKind::depth) {
      out.mark(at + "latitude_deg", {Layer::vehicle, vehicle.name, "latitude_deg"});
      if (vehicle.file.contains("latitude_deg") && !vehicle.file.at("latitude_deg").is_null())
        out.overlay(at + "latitude_deg", vehicle.file.at("latitude_deg"),
                    {Layer::vehicle, vehicle.name, "latitude_deg"});
    }
    if (known.own.contains("bridge")) out.overlay(element, known.own.at("bridge"), known.at.child("bridge"));
  }
}

}  // namespace fathom::config
