#include "config/vehicle/vehicle_config.hpp"

#include <algorithm>
#include <set>

#include "base/nearest.hpp"
#include "base/units.hpp"
#include "config/bridge/bridge_schema.hpp"
#include "config/bridge/byte_source_config.hpp"
#include "config/scenario/sensor_schema.hpp"
#include "config/service_schema.hpp"
#include "config/vehicle/catalogue.hpp"
#include "config/vehicle/raw_object.hpp"

namespace fathom::config {
namespace {

using Violation = std::pair<std::string, std::string>;

std::vector<std::string> words_of(std::initializer_list<SourceKind> kinds) {
  std::vector<std::string> out;
  for (const SourceKind kind : kinds) out.emplace_back(to_string(kind));
  return out;
}

std::string one_of(const std::string& text, const std::vector<std::string>& known) {
  const auto meant = nearest(text, known);
  return "one of " + list_words(known) + (meant ? "; the nearest is " + *meant : "");
}

bool turns(const nlohmann::json& angles) {
  return angles.is_array() && std::any_of(angles.begin(), angles.end(), [](const nlohmann::json& angle) {
           return angle.is_number() && angle != 0.0;
         });
}

/// The key of the bridge that turns the instrument where the vehicle turns it as well; empty: nothing does.
std::string second_mounting(const VehicleInstrument& one) {
  if (one.mounting_rpy_rad == std::array<double, 3>{}) return "";
  const nlohmann::json bridge = nlohmann::json::parse(one.bridge.json);
  for (const char* key : {"/mounting/rpy_deg", "/mounting/R_BS", "/heading_alignment_deg"}) {
    const nlohmann::json::json_pointer at(key);
    if (!bridge.contains(at)) continue;
    const nlohmann::json& value = bridge.at(at);
    if (turns(value.is_array() ? value : nlohmann::json::array({value})) ||
        std::string(key) == "/mounting/R_BS") {
      std::string path = "bridge" + std::string(key);
      std::replace(path.begin(), path.end(), '/', '.');
      return path;
    }
  }
  return "";
}

/// Enabled instruments whose ports collide. What one device measures for one bridge, by one name, comes from
/// one port.
void find_shared_ports(const std::vector<VehicleInstrument>& instruments, std::vector<Violation>& out) {
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const VehicleInstrument& one = instruments[i];
      const VehicleInstrument& other = instruments[k];
      const bool same_device = one.name == other.name && one.role() == other.role();
      if (!one.enabled || !other.enabled || !one.port || !other.port || same_device) continue;
      if (!runtime::collide(*one.port, *other.port)) continue;
      out.emplace_back("instruments." + std::to_string(i) + ".port", port_of_its_own(other.name.str()));
      break;
    }
  }
}

/// Names that nothing in this vehicle can have.
void find_unknown_expected(const VehicleRoles& roles, std::vector<Violation>& out) {
  std::vector<std::string> known = all_services();
  for (const FusionRole& role : roles.fusion) known.push_back(role.name.str());
  for (std::size_t i = 0; i < roles.expected.size(); ++i) {
    if (std::find(known.begin(), known.end(), roles.expected[i]) == known.end())
      out.emplace_back("roles.expected." + std::to_string(i), one_of(roles.expected[i], known));
  }
}

/// An instrument without a name was refused for that.
std::vector<Violation> violations(const VehicleConfig& vehicle) {
  std::vector<Violation> out;
  std::set<std::pair<SourceKind, std::string>> seen;
  bool inertial = false;
  for (std::size_t i = 0; i < vehicle.instruments.size(); ++i) {
    const VehicleInstrument& one = vehicle.instruments[i];
    const std::string key = "instruments." + std::to_string(i) + ".";
    if (!one.name.empty() && !seen.insert({one.kind, one.name.str()}).second)
      out.emplace_back(key + "name", "a name that no other instrument of this kind has");
    inertial = inertial || (one.kind == SourceKind::imu && one.enabled);
    if (one.ros2 && one.port)
      out.emplace_back(key + "ros2", "no port as well: its samples come from one place");
    if (const std::string where = second_mounting(one); !where.empty())
      out.emplace_back(key + "mounting_rpy_deg",
                       "[0, 0, 0] because " + key + where + " turns the same instrument");
  }
  find_shared_ports(vehicle.instruments, out);
  find_unknown_expected(vehicle.roles, out);
  if (!inertial) out.emplace_back("instruments", "an enabled one of kind imu among them");
  const auto known = all_services();
  for (const auto& [service, keys] : vehicle.services) {
    if (std::find(known.begin(), known.end(), service) == known.end())
      out.emplace_back("services." + service, one_of(service, known));
  }
  return out;
}

}  // namespace

std::vector<std::pair<std::string, SourceKind>> instrument_kinds() {
  std::vector<std::pair<std::string, SourceKind>> out;
  for_each_kind([&](auto kind) { out.emplace_back(kind.kWord, kind.kSource); });
  return out;
}

void describe(Schema<VehicleInstrument>& s) {
  using C = VehicleInstrument;
  using enum SourceKind;
  s.field("name", &C::name, "its name in the samples that it gives, e.g. gps").name().required();
  s.field("kind", &C::kind, "what it measures").words(instrument_kinds()).decides().required();
  s.field("model", &C::model,
          "its model, a file of the catalogue without .json: what stands there needs not stand here")
      .optional_name();
  s.field("enabled", &C::enabled, "false: it is in the vehicle and is left out");
  s.field("watched", &C::watched, "false: the monitor does not miss it when it is silent");
  s.field("port", &C::port,
          "where its bytes come from; two instruments of one bridge and one name share the port of the "
          "first, those of "
          "several bridges say the same port with shared: true");
  s.field("protocol", &C::protocol, "what its bytes mean, as in the file of its bridge");
  s.field("rate_hz", &C::rate_hz, "samples per second to expect").unit("Hz").range(0.001, 10'000);
  s.field("latency_s", &C::latency_s, "from the instant of validity to the arrival of the quickest frame")
      .unit("s")
      .range(0, 60);
  s.field("axes", &C::axes, "how it names its axes: forward-right-down or forward-left-up")
      .words({{"frd", AxisNames::frd}, {"flu", AxisNames::flu}})
      .only_for(words_of({imu}));
  s.field("position_m", &C::position_m,
          "where it is, forward, right, down of a point of the vehicle that is the same for all instruments")
      .unit("m")
      .range(-1000, 1000)
      .only_for(words_of({imu, gps, dvl, depth, usbl, propulsion, range, fix, altimeter}))
      .required_for(words_of({gps, dvl, depth, usbl, range}));
  s.field("mounting_rpy_deg", &C::mounting_rpy_rad,
          "which way round it is: roll, pitch, yaw of its axes in the vehicle")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg)
      .only_for(words_of({imu, dvl, heading, usbl}))
      .required_for(words_of({imu, dvl}));
  s.field("bridge", &C::bridge, "further keys of the instrument in the file of its bridge");
  s.field("fusion", &C::fusion,
          "further keys of the instrument in the file of fusion: of engine.sensors, of an IMU of engine.imu");
  s.field("ros2", &C::ros2,
          "in place of a port: it is a topic of ROS 2, with the keys of an input of ros2_gateway")
      .only_for(words_of({imu, gps, dvl, depth}));
}

void describe(Schema<VehicleLimits>& s) {
  using C = VehicleLimits;
  s.field("horizontal_95_m", &C::horizontal_95_m,
          "a larger 95 % radius of the position is an alarm, and how soon it will come is forecast")
      .unit("m")
      .range(0.1, 1e6);
  s.field("heading_deg", &C::heading_deg, "when the 95 % uncertainty of heading passes this is forecast")
      .unit("deg")
      .range(0.01, 180);
  s.field("gps_outage_s", &C::gps_outage_s, "no usable fix for this long is an outage")
      .unit("s")
      .range(0.2, 3600);
  s.field("alignment_s", &C::alignment_s, "not aligned this long after the start is an alarm")
      .unit("s")
      .range(1, 1e5);
}

void describe(Schema<FusionRole>& s) {
  s.field("name", &FusionRole::name, "its instance; give it to the service with --set instance=NAME")
      .name()
      .required();
  s.field("strength", &FusionRole::strength, "of its navigation state: the strongest living one is heard")
      .range(0, 1'000'000);
}

void describe(Schema<VehicleRoles>& s) {
  s.field("fusion", &VehicleRoles::fusion, "the fusion services; where there are several they stand by");
  s.field("expected", &VehicleRoles::expected,
          "services that the monitor misses, besides fusion and the bridges of the instruments");
  s.check([](const VehicleRoles& roles) -> Violation {
    if (roles.fusion.empty()) return {"fusion", "at least one"};
    std::set<std::string> names;
    for (const FusionRole& one : roles.fusion) {
      if (!names.insert(one.name.str()).second) return {"fusion", "different names"};
    }
    return {};
  });
}

void describe(Schema<VehicleConfig>& s) {
  using C = VehicleConfig;
  s.field("name", &C::name, "name of the vehicle, the first key of every topic").name().required();
  s.field("network", &C::network, "the vehicle network, as section bus of every service");
  s.field(
       "latitude_deg", &C::latitude_rad,
       "of the area of operation, for gravity where a pressure becomes a depth; needed with a depth sensor")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg)
      .nullable();
  s.field("instruments", &C::instruments, "what the vehicle carries").required();
  s.field("limits", &C::limits, "what the vehicle is watched for");
  s.field("roles", &C::roles, "which services there are, and which of them leads");
  s.field("log", &C::log, "the log of every service");
  s.field("realtime", &C::realtime, "scheduling of every service");
  s.field("services", &C::services, "further keys of single services, by their names, as in their own files");
  s.check_parts(violations);
}

VehicleConfig load_vehicle(const std::string& file) {
  VehicleConfig out;
  Mistakes mistakes;
  mistakes.in([&] { out = load<VehicleConfig>({file, {}}); });
  check_models(file, mistakes);
  mistakes.raise();
  return out;
}

std::vector<std::string> all_services() {
  std::vector<std::string> out;
  for (const ConfigKind& kind : config_kinds()) {
    if (kind.name != "hydro" && kind.name != "scenario" && kind.name != "vehicle" && kind.name != "catalogue")
      out.emplace_back(kind.name);
  }
  return out;
}

std::vector<std::string> services_of(const VehicleConfig& vehicle) {
  std::set<std::string> out{"fusion", "monitor"};
  for (const VehicleInstrument& one : vehicle.instruments) {
    if (one.enabled) out.emplace(one.role());
  }
  for (const auto& [service, keys] : vehicle.services) out.insert(service);
  return {out.begin(), out.end()};
}

ConfigKind vehicle_kind() {
  ConfigKind kind = make_kind<VehicleConfig>("vehicle");
  kind.check = [](const LoadRequest& request) {
    if (!request.sets.empty()) {
      (void)load<VehicleConfig>(request);
      return;
    }
    const VehicleConfig vehicle = load_vehicle(request.file);
    Mistakes mistakes;
    for (const std::string& service : services_of(vehicle)) {
      for (const ConfigKind& one : config_kinds()) {
        if (one.name == service) mistakes.in([&] { one.check(with_vehicle({}, request.file, service)); });
      }
    }
    mistakes.raise();
  };
  return kind;
}

}  // namespace fathom::config
