// What a vehicle means for the gateway to ROS 2: which instruments are topics there.

#include "config/vehicle/sources.hpp"

namespace fathom::config {
namespace {

/// The message that an instrument of a kind usually is.
std::string usual_message(SourceKind kind) {
  switch (kind) {
    case SourceKind::gps:
      return "nav_sat_fix";
    case SourceKind::depth:
      return "fluid_pressure";
    case SourceKind::dvl:
      return "dvl";
    default:
      return "imu";
  }
}

}  // namespace

void ros2_layers(const Sources& vehicle, Layers& out) {
  std::size_t count = 0;
  for (const Known& known : vehicle.instruments) {
    const VehicleInstrument& one = *known.config;
    if (!one.ros2) continue;
    const Origin own = known.at.child("ros2");
    const std::string at = append(out, "inputs", count++, own);
    out.overlay(at + "kind", usual_message(one.kind), known.at.child("kind"));
    out.overlay(at + "sensor", one.name.str(), known.at.child("name"));
    put(out, at + "rate_hz", find(known, "rate_hz"));
    if (one.kind == SourceKind::imu) put(out, at + "axes", find(known, "axes"));
    if (one.kind == SourceKind::depth && vehicle.file.contains("latitude_deg") &&
        !vehicle.file.at("latitude_deg").is_null()) {
      out.overlay(at + "lat_deg", vehicle.file.at("latitude_deg"),
                  {Layer::vehicle, vehicle.name, "latitude_deg"});
    }
    out.overlay(at.substr(0, at.size() - 1), known.own.at("ros2"), own);
  }
}

}  // namespace fathom::config
