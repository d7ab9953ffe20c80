#pragma once

#include <cmath>

#include "samples/gps.hpp"

namespace fathom {

/// Beyond these a fix may still weigh in by its sigma, but nobody navigates "by GPS": neither the mode
/// gps_aided nor the monitor's outage clocks count it. One value for both. The usual table of dilution of
/// precision calls 20 and more poor: fixes to be discarded.
inline constexpr double kGpsSigmaLimit_m =
    100.0;  ///< horizontal, one standard deviation, as the receiver says
inline constexpr double kGpsHdopLimit = 20.0;

/// What the receiver does not say is not held against it.
[[nodiscard]] inline bool is_accurate(const GpsSample& sample) {
  const double sigma_m = std::hypot(sample.position_sigma_N_m[0], sample.position_sigma_N_m[1]);
  return !(sigma_m > kGpsSigmaLimit_m) && !(sample.hdop > kGpsHdopLimit);
}

}  // namespace fathom
