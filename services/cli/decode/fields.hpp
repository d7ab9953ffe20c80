#pragma once

#include <array>
#include <numbers>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/unknown.hpp"

namespace fathom::cli {

using Json = nlohmann::ordered_json;  // writes not-a-number as null

/// Degrees of radians; exact for the values that instruments send in decimal degrees.
inline double degrees(double radians) {
  return radians * (180.0 / std::numbers::pi);
}

/// Adds what a sample says to a line of `fathom decode --json`; of each kind in fields/.
template <class Sample>
void add_fields(Json& line, const Sample& sample);

}  // namespace fathom::cli
