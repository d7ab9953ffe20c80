#pragma once

#include <cmath>

#include "estimation/event_sample.hpp"

namespace fathom::estimation {

/// Standard deviations that an order or a sample may state, in SI units. No instrument of a vehicle knows
/// anything to a micrometre, a micrometre a second or a microradian; beyond a million it is not known at all.
/// What is smaller or larger is a mistake in units or worse.
inline constexpr double kLeastSigma = 1e-6;
inline constexpr double kMostSigma = 1e6;

/// False for NaN.
[[nodiscard]] inline bool sound_sigma(double sigma) {
  return sigma >= kLeastSigma && sigma <= kMostSigma;
}

/// No sigma that the sample states lies outside; unknown ones do not.
[[nodiscard]] bool sound_sigmas(const EventSample& sample);

}  // namespace fathom::estimation
