#pragma once

// Factors from the units of configuration files and data sheets to SI.

#include "base/units.hpp"

namespace fathom::estimation {

inline constexpr double kRadPerSecond_per_degPerHour = kRadPerDeg / 3600.0;
inline constexpr double kPerSqrtSecond_per_perSqrtHour = 1.0 / 60.0;

}  // namespace fathom::estimation
