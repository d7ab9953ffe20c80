#pragma once

#include <cmath>

namespace fathom {

/// How far an ordered position may lie from the one that navigation has: six sigma of both. What lies further
/// is either a slip or moves the vehicle on every chart; it has to be ordered twice (Command::confirmed).
/// Variances of the horizontal position in m^2, `sigma_m` of the order; NaN where one is unknown.
[[nodiscard]] inline double allowed_departure_m(double variance_N_m2, double variance_E_m2, double sigma_m) {
  constexpr double kSigmas = 6.0;
  return kSigmas * std::sqrt(variance_N_m2 + variance_E_m2 + sigma_m * sigma_m);
}

}  // namespace fathom
