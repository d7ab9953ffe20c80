#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.hpp"
#include "sim/sensor_config.hpp"

namespace fathom::sim {

struct Scenario;

using Bytes = std::vector<std::uint8_t>;

[[nodiscard]] inline Bytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

/// What a device knows besides the sample.
struct DeviceCall {
  std::string_view protocol;  ///< the registry's own name of the configured one
  const Scenario& scenario;
  TimeNs power_on_ns = 0;
};

/// The error model of a kind: `type` is made of the sensor's configuration, what it needs of the scenario and
/// the seed. Its sample() is a sample, or nothing where none is taken.
template <class Sample>
struct ModelOf;

/// The device of a kind: kProtocols by the registry's own names, and the bytes that it sends for a sample.
template <class Sample>
class SimulatedDevice;

}  // namespace fathom::sim
