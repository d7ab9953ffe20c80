#pragma once

#include <numbers>

namespace fathom {

/// Of the third General Conference on Weights and Measures, 1901: what data sheets call 1 g.
inline constexpr double kStandardGravity_m_s2 = 9.80665;

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;

}  // namespace fathom
