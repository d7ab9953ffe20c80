#pragma once

// For *.cpp of this folder: an object of a file that is kept as it is.

#include "config/json/schema.hpp"
#include "config/vehicle/vehicle_config.hpp"

namespace fathom::config {

inline void describe(Schema<RawObject>& /*s*/) {}

inline void load_value(const nlohmann::json& json, RawObject& out, const Rules<RawObject>& /*rules*/,
                       const Place& place) {
  if (!json.is_object()) place.fail(json, "an object");
  out.json = json.dump();
}

inline nlohmann::json dump_value(const RawObject& value, const Rules<RawObject>& /*rules*/) {
  return nlohmann::json::parse(value.json);
}

template <>
inline nlohmann::json described_schema<RawObject>() {
  return {{"type", "object"}};
}

}  // namespace fathom::config
