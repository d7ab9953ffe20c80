#pragma once

#include <span>

#include "estimation/aiding/model.hpp"
#include "estimation/event_sample.hpp"

namespace fathom::estimation {

/// One model in the list.
struct AidingEntry {
  SourceKind source;
  const char* name;
  /// Appends the model's rows when the sample is usable.
  Usable (*observe)(const AidingInput& input, const EventSample& sample, Observation& out);
  /// What a sample means that it took rows from.
  AidingPolicy (*policy)(const SensorConfig& sensor, const EventSample& sample);
  /// Whether the model may ever take rows from what this sensor measures.
  bool (*may_aid)(const SensorConfig& sensor);
};

/// Every aiding model there is. A new one is one header in this folder and one line in registry.cpp. A sample
/// goes through all the entries of its source; their rows are judged together.
[[nodiscard]] std::span<const AidingEntry> aiding_registry();
/// Whether any model may ever take rows from what this sensor measures, the vehicle model apart.
[[nodiscard]] bool may_aid(const SensorConfig& sensor);
/// Whether any model of the sample's kind takes a position from it.
[[nodiscard]] bool may_place(const SensorConfig& sensor, const EventSample& sample);

}  // namespace fathom::estimation
