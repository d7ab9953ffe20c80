#pragma once

namespace fathom::estimation {

/// Standard deviations that an order or a sample may state, in SI units. No instrument of a vehicle knows
/// anything to a micrometre, a micrometre a second or a microradian; beyond a million it is not known at all.
/// What is smaller or larger is a mistake in units or worse.
inline constexpr double kLeastSigma = 1e-6;
inline constexpr double kMostSigma = 1e6;

[[nodiscard]] inline bool sound_sigma(double sigma) {
  return sigma >= kLeastSigma && sigma <= kMostSigma;
}

}  // namespace fathom::estimation
