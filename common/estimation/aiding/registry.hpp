#pragma once

#include <array>
#include <span>

#include "estimation/aiding/model.hpp"
#include "estimation/hydro/water_velocity.hpp"
#include "estimation/navigator/measurement.hpp"

namespace fathom::estimation {

/// All that an aiding model is given.
struct AidingInput {
  const AidingState& state;
  const SensorConfig& sensor;
  double surface_altitude_m;  ///< used where it is not estimated
  const VehicleModelConfig* vehicle_model = nullptr;
  const hydro::WaterVelocity* water = nullptr;  ///< what the vehicle model foretells, where it is switched on
  double unused_s = kUnknown;                   ///< since the last measurement of this sensor that was used
};

/// One model in the list. `observe` appends its rows when the sample is usable.
struct AidingEntry {
  SourceKind source;
  const char* name;
  Usable (*observe)(const AidingInput& input, const EventSample& sample, Observation& out);
};

/// Every aiding model there is. A new one is one header in this folder and one line in registry.cpp. A sample
/// goes through all the entries of its source; their rows are judged together.
[[nodiscard]] std::span<const AidingEntry> aiding_registry();

}  // namespace fathom::estimation
