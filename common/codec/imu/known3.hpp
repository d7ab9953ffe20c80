#pragma once

#include <array>

#include "base/unknown.hpp"

namespace fathom::codec {

/// Whether all three components of a vector are known.
[[nodiscard]] inline bool known3(const std::array<double, 3>& values) {
  return known(values[0]) && known(values[1]) && known(values[2]);
}

}  // namespace fathom::codec
