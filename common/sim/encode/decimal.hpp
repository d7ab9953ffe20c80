#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "base/unknown.hpp"

namespace fathom::sim::encode {

/// A number with so many decimals; blank where it is unknown.
[[nodiscard]] inline std::string decimal(double value, int decimals) {
  if (!known(value)) return {};
  std::array<char, 64> text{};
  const int length = std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return {text.data(), static_cast<std::size_t>(std::clamp(length, 0, 63))};
}

/// For fields that cannot be blank.
[[nodiscard]] inline double zero_if_unknown(double value) {
  return known(value) ? value : 0.0;
}

}  // namespace fathom::sim::encode
