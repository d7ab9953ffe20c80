#pragma once

#include <cmath>

namespace fathom::estimation {

/// Whether a shaft can turn that fast at all; nothing known is refused as well.
[[nodiscard]] inline bool believable_rpm(double rpm) {
  return std::abs(rpm) < 1e5;
}

}  // namespace fathom::estimation
