#include "sim/device_encoder.hpp"

#include <algorithm>
#include <optional>

#include "codec/registry.hpp"

namespace fathom::sim {
namespace {

/// The registry's own name of a protocol given by name or alias.
std::string_view canonical(std::string_view protocol) {
  const codec::Protocol* found = codec::find_protocol(protocol);
  return found == nullptr ? std::string_view{} : found->name;
}

}  // namespace

std::array<std::pair<SourceKind, const SensorCommon*>, kSourceKinds> sensors_of(const SensorSuite& suite) {
  std::array<std::pair<SourceKind, const SensorCommon*>, kSourceKinds> out{};
  for_each_kind([&](auto kind) {
    out[static_cast<std::size_t>(kind.kSource)] = {kind.kSource,
                                                   &suite.of<typename decltype(kind)::Sample>()};
  });
  return out;
}

const SensorCommon* find_sensor(const SensorSuite& suite, std::string_view kind) {
  for (const auto& [source, sensor] : sensors_of(suite)) {
    if (to_string(source) == kind) return sensor;
  }
  return nullptr;
}

bool can_encode(SourceKind kind, std::string_view protocol) {
  const auto name = canonical(protocol);
  bool can = false;
  for_each_kind([&](auto row) {
    if (row.kSource != kind) return;
    const auto& spoken = SimulatedDevice<typename decltype(row)::Sample>::kProtocols;
    can = std::find(spoken.begin(), spoken.end(), name) != spoken.end();
  });
  return can;
}

bool can_encode(std::string_view kind, std::string_view protocol) {
  const std::optional<SourceKind> source = kind_named(kind);
  return source && can_encode(*source, protocol);
}

DeviceEncoder::DeviceEncoder(const Scenario& scenario, TimeNs power_on_ns)
    : scenario_(scenario), power_on_ns_(power_on_ns) {}

std::vector<std::uint8_t> DeviceEncoder::encode(const Measurement& measurement) {
  return std::visit(
      [this]<class Sample>(const Sample& sample) -> Bytes {
        const std::string& protocol = scenario_.sensors.of<Sample>().protocol;
        if (protocol.empty()) return {};
        return std::get<SimulatedDevice<Sample>>(devices_).encode(
            sample, {canonical(protocol), scenario_, power_on_ns_});
      },
      measurement);
}

}  // namespace fathom::sim
