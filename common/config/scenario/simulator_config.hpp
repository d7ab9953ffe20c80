#pragma once

#include <cstdint>
#include <string>

#include "base/time.hpp"
#include "config/common_config.hpp"
#include "config/registry.hpp"
#include "config/service_config.hpp"
#include "sim/scenario.hpp"

namespace fathom::config {

/// deploy/config/simulator.json
struct SimulatorConfig {
  CommonConfig common;
  std::string scenario = "survey";  ///< name below scenario_dir, or a file
  std::string scenario_dir;         ///< empty: found beside the executable or where installed
  std::string dataset;  ///< folder of a recorded vehicle to play instead; the scenario names the devices
  std::uint64_t seed = 1;
  TimeNs epoch_ns = 0;         ///< UTC of the start; 0: start_delay_s from now, on a whole second
  double start_delay_s = 1.0;  ///< vehicle time
  std::string link_dir = "/tmp/fathom/devices";  ///< pseudo-terminals appear here under their names
  int port_offset = 0;                           ///< added to every TCP and UDP port of the scenario
  double truth_rate_hz = 20.0;
  sim::Scenario loaded;  ///< what `scenario` names; filled by load_service_config()
};

/// Loads the scenario as well, so that --check judges both files.
template <>
LoadedConfig<SimulatorConfig> load_service_config(const LoadRequest& request);

[[nodiscard]] ConfigKind simulator_kind();

}  // namespace fathom::config
