#pragma once

#include "base/units.hpp"
#include "estimation/navigator/estimate.hpp"

namespace fathom::estimation {

inline constexpr TimeNs kNow_ns = 1'000 * kNsPerSecond;

/// An estimate at the equator that navigates and knows each axis as well as is said.
inline Estimate navigating(const estimation::Setup& setup, double position_sigma_m,
                           double velocity_sigma_m_s = 0.1) {
  Estimate estimate(setup);
  estimate.now_ns = kNow_ns;
  std::array<double, kMaxStates> sigma = setup.initial_sigma;
  for (std::size_t i = 0; i < 3; ++i) {
    sigma[i] = position_sigma_m;
    sigma[3 + i] = velocity_sigma_m_s;
    sigma[6 + i] = kRadPerDeg;
  }
  estimate.begin(FilterState{}, sigma);
  return estimate;
}

}  // namespace fathom::estimation
