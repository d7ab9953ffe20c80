#pragma once

// For *.cpp of this folder: what is known of a vehicle, and how it becomes the configuration of a service.

#include <string>
#include <string_view>
#include <vector>

#include "codec/registry.hpp"
#include "config/json/layers.hpp"
#include "config/vehicle/vehicle_config.hpp"

namespace fathom::config {

/// What is known of one instrument, from the least to the most particular.
struct Known {
  const VehicleInstrument* config = nullptr;
  nlohmann::json own;    // as it stands in the vehicle's file
  Origin at;             // there
  nlohmann::json model;  // as it stands in the catalogue; null: of no model
  Origin model_at;
};

struct Sources {
  VehicleConfig config;
  nlohmann::json file;
  std::string name;
  std::vector<Known> instruments;  // the enabled ones
};

/// Of what nobody said.
inline const Origin kStandard{};

/// The value of a key in the vehicle's file, else in the catalogue, else the default.
struct Found {
  nlohmann::json value;
  Origin origin;
};
[[nodiscard]] Found find(const Known& known, const std::string& key, nlohmann::json standard = nullptr);
/// What its bytes are; null where nobody says it, or says one that is none.
[[nodiscard]] const codec::Protocol* protocol_of(const Known& known);
/// Nothing where the value is null.
void put(Layers& out, const std::string& key, const Found& found);
/// Appends an element to an array and says what it goes back to. Returns its key with a dot behind it.
[[nodiscard]] std::string append(Layers& out, const std::string& array, std::size_t index,
                                 const Origin& origin);
/// The inertial unit that is navigated with: the first one.
[[nodiscard]] const Known& inertial_unit(const Sources& vehicle);

void bridge_layers(const Sources& vehicle, std::string_view role, Layers& out);
/// Which of the fusion services it is stands in the request's overrides.
void fusion_layers(const Sources& vehicle, const LoadRequest& request, Layers& out);
void monitor_layers(const Sources& vehicle, Layers& out);
void ros2_layers(const Sources& vehicle, Layers& out);

}  // namespace fathom::config
