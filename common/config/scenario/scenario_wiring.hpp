#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sim/scenario.hpp"

namespace fathom::config {

struct Wiring {
  std::string link_dir = "/tmp/fathom/devices";  ///< as the simulator's
  int port_offset = 0;                           ///< as the simulator's
};

/// The bridge's end of a simulated device's link, shared where bridges of other instruments read it as well.
[[nodiscard]] nlohmann::json port_of(const sim::SensorCommon& sensor, const sim::Scenario& scenario,
                                     const Wiring& wiring);
/// From validity to arrival, as a bridge of this instrument counts it: of the quickest frame where the device
/// has a counter, of the mean one where nothing but the arrival is known, 0 where the frame says its UTC or
/// age.
[[nodiscard]] double latency_of(const sim::SensorCommon& sensor, bool says_utc);

/// What each service has to be told by --set so that it fits a simulated vehicle: bridges get source,
/// protocol, rate and time mode of their first instrument from the scenario's devices; then come the
/// scenario's own overrides. Key: service, e.g. "imu_bridge"; value: `key.sub=value` in order.
[[nodiscard]] std::map<std::string, std::vector<std::string>> service_overrides(const sim::Scenario& scenario,
                                                                                const Wiring& wiring);

}  // namespace fathom::config
