#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "base/time.hpp"
#include "sim/scenario.hpp"
#include "sim/simulation.hpp"

namespace fathom::sim {

/// The parts of a suite, one a kind.
[[nodiscard]] std::array<std::pair<SourceKind, const SensorCommon*>, kSourceKinds> sensors_of(
    const SensorSuite& suite);
/// The sensor's part of a suite by the kind's word; null for others.
[[nodiscard]] const SensorCommon* find_sensor(const SensorSuite& suite, std::string_view kind);

/// Whether the simulator speaks this protocol for this kind of sensor. Names and aliases of
/// codec/registry.hpp.
[[nodiscard]] bool can_encode(SourceKind kind, std::string_view protocol);
[[nodiscard]] bool can_encode(std::string_view kind, std::string_view protocol);

/// Turns measurements into the bytes that the configured devices send for them. Device clocks: the IMU counts
/// since `power_on_ns`, the DVL's calendar clock and Water Linked times show UTC, GPS and USBL carry UTC.
class DeviceEncoder {
 public:
  DeviceEncoder(const Scenario& scenario, TimeNs power_on_ns);

  /// Empty when the sensor has no device output, or its device waits for more.
  [[nodiscard]] std::vector<std::uint8_t> encode(const Measurement& measurement);

 private:
  template <class... Samples>
  using Devices = std::tuple<SimulatedDevice<Samples>...>;

  Scenario scenario_;
  TimeNs power_on_ns_;
  Kinds::Samples<Devices> devices_;
};

}  // namespace fathom::sim
