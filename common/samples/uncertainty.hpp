#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/unknown.hpp"

namespace fathom {

/// Radius around the estimate that holds the true horizontal position with 95 % probability, from a row-major
/// north-east-down position covariance [m^2]. NaN when that is unknown or not a covariance.
///
/// R95 = K(c) * sigma_major with c = sigma_minor / sigma_major and Leenhouts' polynomial for K (1.96 for a
/// line, 2.45 for a circle), Navigation 32(1), 1985.
[[nodiscard]] inline double horizontal_95_m(const std::array<double, 9>& covariance_N_m2) {
  const double nn = covariance_N_m2[0];
  const double ne = 0.5 * (covariance_N_m2[1] + covariance_N_m2[3]);
  const double ee = covariance_N_m2[4];
  const double mean = 0.5 * (nn + ee);
  const double split = std::hypot(0.5 * (nn - ee), ne);
  if (!(nn >= 0.0) || !(ee >= 0.0) || !std::isfinite(mean + split)) return kUnknown;
  const double major = std::sqrt(mean + split);
  if (major == 0.0) return 0.0;
  const double c = std::sqrt(std::max(0.0, mean - split)) / major;
  return major * (1.960790 + c * (0.004071 + c * (0.114276 + c * 0.371625)));
}

/// Half-width that holds the true height or depth with 95 % probability.
[[nodiscard]] inline double vertical_95_m(const std::array<double, 9>& covariance_N_m2) {
  return covariance_N_m2[8] >= 0.0 ? 1.959964 * std::sqrt(covariance_N_m2[8]) : kUnknown;
}

}  // namespace fathom
