#pragma once

#include "base/time.hpp"

namespace fathom::console {

inline constexpr TimeNs kUtc = 1'700'000'000 * kNsPerSecond;  ///< when the tests begin

}  // namespace fathom::console
