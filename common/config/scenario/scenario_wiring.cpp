#include "config/scenario/scenario_wiring.hpp"

#include <numbers>
#include <set>
#include <string_view>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "codec/registry.hpp"
#include "samples/kinds.hpp"
#include "sim/device_encoder.hpp"

namespace fathom::config {
namespace {

using nlohmann::json;

// The bridge's end of a device's link.
json source_of(const sim::LinkConfig& link, const Wiring& wiring) {
  switch (link.type) {
    case sim::LinkConfig::Type::pty:
      return {{"type", "serial"}, {"path", wiring.link_dir + "/" + link.path}, {"baud", 921600}};
    case sim::LinkConfig::Type::tcp_server:
      return {{"type", "tcp_client"}, {"address", link.address}, {"port", link.port + wiring.port_offset}};
    case sim::LinkConfig::Type::udp:
      break;
  }
  return {{"type", "udp"}, {"address", link.address}, {"port", link.port + wiring.port_offset}};
}

// Whether bridges of several roles read what comes over the link.
bool is_shared(const sim::LinkConfig& link, const sim::Scenario& scenario) {
  std::set<std::string_view> roles;
  for (const auto& [kind, sensor] : sim::sensors_of(scenario.sensors)) {
    if (sensor->enabled && !sensor->protocol.empty() && sensor->link == link) roles.insert(role_of(kind));
  }
  return roles.size() > 1;
}

// Devices with UTC are trusted, counters are tracked, the rest is known by its latency.
codec::DeviceClock clock_of(const sim::SensorCommon& sensor) {
  const codec::Protocol* protocol = codec::find_protocol(sensor.protocol);
  return protocol == nullptr ? codec::DeviceClock::none : protocol->clock;
}
bool has_counter(const sim::SensorCommon& sensor) {
  return clock_of(sensor) == codec::DeviceClock::counter;
}
bool has_utc(const sim::SensorCommon& sensor) {
  return clock_of(sensor) == codec::DeviceClock::utc;
}

json time_of(const sim::SensorCommon& sensor) {
  const double latency_s = latency_of(sensor, false);
  if (has_counter(sensor)) return {{"mode", "device_clock"}, {"minimum_latency_s", latency_s}};
  if (has_utc(sensor)) return {{"mode", "device_utc"}};
  return {{"mode", "arrival"}, {"latency_s", latency_s}};
}

}  // namespace

json port_of(const sim::SensorCommon& sensor, const sim::Scenario& scenario, const Wiring& wiring) {
  json out = source_of(sensor.link, wiring);
  if (is_shared(sensor.link, scenario)) out["shared"] = true;
  return out;
}

double latency_of(const sim::SensorCommon& sensor, bool says_utc) {
  const codec::Protocol* protocol = codec::find_protocol(sensor.protocol);
  const bool tells_age = protocol != nullptr && protocol->traits.tells_age;
  if (says_utc || tells_age || has_utc(sensor)) return 0.0;
  if (has_counter(sensor)) return sensor.latency_s;
  return sensor.latency_s + 0.5 * sensor.jitter_s;
}

std::map<std::string, std::vector<std::string>> service_overrides(const sim::Scenario& scenario,
                                                                  const Wiring& wiring) {
  std::map<std::string, std::vector<std::string>> out;
  for_each_kind([&](auto kind) {
    using Sample = typename decltype(kind)::Sample;
    const sim::SensorCommon& sensor = scenario.sensors.of<Sample>();
    if (!sensor.enabled || sensor.protocol.empty()) return;
    auto& sets = out[std::string(kind.kRole)];
    if (!sets.empty()) return;  // what another kind of the same instrument said
    json time = time_of(sensor);
    // NMEA receivers say the time of day of their fix.
    if constexpr (std::is_same_v<Sample, GpsSample>) time = {{"mode", "device_utc"}};
    sets.push_back("sensors.0.source=" + port_of(sensor, scenario, wiring).dump());
    sets.push_back("sensors.0.protocol=" + sensor.protocol);
    sets.push_back("sensors.0.rate_hz=" + json(sensor.rate_hz).dump());
    sets.push_back("sensors.0.time=" + time.dump());
    if constexpr (std::is_same_v<Sample, DepthSample>) {
      const double latitude_deg = scenario.start.latitude_rad * 180.0 / std::numbers::pi;
      sets.push_back("sensors.0.latitude_deg=" + json(latitude_deg).dump());
    }
  });
  for (const auto& [service, values] : scenario.services) {
    for (const auto& [key, value] : values) out[service].push_back(key + "=" + value);
  }
  return out;
}

}  // namespace fathom::config
