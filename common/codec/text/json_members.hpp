#pragma once

#include <nlohmann/json.hpp>

#include "base/unknown.hpp"

namespace fathom::codec {

/// A member of a JSON object has another type than the protocol gives it. Thrown and caught inside a codec.
struct WrongType {};

/// The number at this key; unknown where there is none, or null.
/// @throws WrongType if it is anything else than a number.
[[nodiscard]] inline double number_in(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return kUnknown;
  if (!found->is_number()) throw WrongType{};
  return found->get<double>();
}

}  // namespace fathom::codec
