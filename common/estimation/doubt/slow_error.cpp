#include "estimation/doubt/slow_error.hpp"

#include <cmath>

namespace fathom::estimation {

SlowError::SlowError(int first, const std::array<double, kMaxStates>& sigma) : first_(first) {
  for (std::size_t axis = 0; axis < kAxes && first >= 0; ++axis) {
    const double one = sigma[static_cast<std::size_t>(state_of(axis))];
    said_N_m2_[axis] = one * one;
  }
  begin();
}

std::array<double, SlowError::kAxes> SlowError::sigma_N_m() const {
  std::array<double, kAxes> out{};
  for (std::size_t axis = 0; axis < kAxes; ++axis) out[axis] = std::sqrt(variance_N_m2_[axis]);
  return out;
}

double SlowError::share_of(std::size_t axis, double more_m2, const ErrorFilter& filter) const {
  // (GATE-13)
  constexpr double kWorthIt = 0.2;  // of the variance: a tenth of the sigma
  const int state = state_of(axis);
  const double variance = variance_N_m2_[axis];
  if (state < 0 || !(variance > 0.0) || !(more_m2 > kWorthIt * variance)) return 0.0;
  const double taken_back = 1.0 / variance - 1.0 / (variance + more_m2);
  return taken_back / (1.0 - taken_back * filter(state, state));
}

void SlowError::drive(const StateDrift& drift, double dt_s, ErrorFilter& covariance) const {
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    if (!(variance_N_m2_[axis] > said_N_m2_[axis])) continue;
    const double more = variance_N_m2_[axis] / said_N_m2_[axis] - 1.0;
    covariance.widen(state_of(axis), more * drift.walk(state_of(axis)) * dt_s);
  }
}

}  // namespace fathom::estimation
