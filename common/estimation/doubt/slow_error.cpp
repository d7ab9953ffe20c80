#include "estimation/doubt/slow_error.hpp"

#include <cmath>

namespace fathom::estimation {

SlowError::SlowError(const StateIndex& index, Group group, const std::array<double, kMaxStates>& sigma)
    : first_(index.of(group)), axes_(index.has(group) ? group_size(group) : 0) {
  for (int i = first_; has(i); ++i) {
    const double one = sigma[static_cast<std::size_t>(i)];
    said_N_m2_[axis_of(i)] = one * one;
  }
  begin();
}

std::array<double, SlowError::kAxes> SlowError::sigma_N_m() const {
  std::array<double, kAxes> out{};
  for (std::size_t axis = 0; axis < kAxes; ++axis) out[axis] = std::sqrt(variance_N_m2_[axis]);
  return out;
}

std::optional<SlowError::Grown> SlowError::grown() const {
  const std::size_t worse = variance_N_m2_[1] > variance_N_m2_[0] ? 1 : 0;
  if (!(variance_N_m2_[worse] > said_N_m2_[worse])) return std::nullopt;
  return Grown{std::sqrt(variance_N_m2_[worse]), std::sqrt(said_N_m2_[worse])};
}

double SlowError::share_of(int state, double variance_m2, const ErrorFilter& filter) const {
  // (GATE-13)
  constexpr double kWorthIt = 1.2;  // of the variance: a tenth of the sigma
  const double variance = variance_N_m2_[axis_of(state)];
  if (!(variance > 0.0) || !(variance_m2 > kWorthIt * variance)) return 0.0;
  const double taken_back = 1.0 / variance - 1.0 / variance_m2;
  return taken_back / (1.0 - taken_back * filter(state, state));
}

void SlowError::drive(const StateDrift& drift, double dt_s, ErrorFilter& covariance) const {
  for (int i = first_; has(i); ++i) {
    const std::size_t axis = axis_of(i);
    if (!(variance_N_m2_[axis] > said_N_m2_[axis])) continue;
    covariance.widen(i, (variance_N_m2_[axis] / said_N_m2_[axis] - 1.0) * drift.walk(i) * dt_s);
  }
}

}  // namespace fathom::estimation
