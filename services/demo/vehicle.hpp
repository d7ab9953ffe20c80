#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/scenario/scenario_wiring.hpp"
#include "sim/scenario.hpp"

namespace fathom::demo {

/// What of a run its vehicle's file says, besides the instruments.
struct VehicleOfRun {
  nlohmann::json network;               ///< section "network"
  std::vector<std::string> bridges;     ///< without "_bridge": an instrument of another one is left out
  bool standby = false;                 ///< a second fusion stands by
  std::vector<std::string> expected{};  ///< services that the monitor misses, besides fusion and the bridges
};

/// The file of a simulated vehicle: of `common`, which has an instrument of each kind, those that the
/// scenario has, with their protocols, rates, delays and the ports of its devices.
[[nodiscard]] nlohmann::json vehicle_of(nlohmann::json common, const sim::Scenario& scenario,
                                        const config::Wiring& wiring, const VehicleOfRun& run);

}  // namespace fathom::demo
