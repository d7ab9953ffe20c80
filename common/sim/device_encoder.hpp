#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
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

  /// Empty when the sensor has no device output, and for the first of two measurements that share an
  /// ensemble: what a DVL measures of the bottom waits for the water layer.
  [[nodiscard]] std::vector<std::uint8_t> encode(const Measurement& measurement);

 private:
  std::vector<std::uint8_t> pd0(const DvlSample& sample);

  Scenario scenario_;
  TimeNs power_on_ns_;
  std::uint32_t ensemble_ = 0;
  TimeNs last_dvl_ns_ = 0;
  std::optional<DvlSample> ping_;  ///< on the bottom, until its water layer comes
};

}  // namespace fathom::sim
