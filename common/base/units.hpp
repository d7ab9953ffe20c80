#pragma once

#include <numbers>

// Factors from the units of data sheets, configuration files and instruments to SI.

namespace fathom {

/// Of the third General Conference on Weights and Measures, 1901: what data sheets call 1 g.
inline constexpr double kStandardGravity_m_s2 = 9.80665;
inline constexpr double kMilliG_m_s2 = 1e-3 * kStandardGravity_m_s2;

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;
inline constexpr double kDegPerHour_rad_s = kRadPerDeg / 3600.0;

/// Of a random walk: what grows by 1 in the square root of an hour.
inline constexpr double kPerSqrtHour_per_sqrt_s = 1.0 / 60.0;

inline constexpr double kKnot_m_s = 1852.0 / 3600.0;  ///< international, 1929
inline constexpr double kKmh_m_s = 1.0 / 3.6;
inline constexpr double kFoot_m = 0.3048;  ///< international, 1959

}  // namespace fathom
