#pragma once

#include <cmath>
#include <limits>

namespace fathom {

/// Value of every quantity that is not known. Never 0, never -1.
inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

[[nodiscard]] inline bool known(double value) {
  return !std::isnan(value);
}

}  // namespace fathom
