#pragma once

#include "base/time.hpp"

namespace fathom {

/// What a position that somebody gives can mean, whichever way it comes in.
struct PositionLimits {
  double least_depth_m;
  double most_depth_m;
  double least_sigma_m;
  double most_sigma_m;
};
inline constexpr PositionLimits kOrderedPosition{-100.0, 11'000.0, 0.1, 1e5};
inline constexpr PositionLimits kToldPosition{-50.0, 12'000.0, 0.01, 1e5};
/// So long ago the vehicle may have been where it is told to have been.
inline constexpr DurationNs kOldestTold_ns = 7200 * kNsPerSecond;

}  // namespace fathom
