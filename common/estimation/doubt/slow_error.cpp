#include "estimation/doubt/slow_error.hpp"

#include <cmath>

namespace fathom::estimation {

SlowError::SlowError(const StateIndex& index, Group group, const std::array<double, kMaxStates>& sigma)
    : first_(index.of(group)), axes_(index.has(group) ? group_size(group) : 0) {
  for (int i = first_; has(i); ++i) {
    const double one = sigma[static_cast<std::size_t>(i)];
    said_[axis_of(i)] = one * one;
  }
  begin();
}

std::array<double, SlowError::kAxes> SlowError::sigma() const {
  std::array<double, kAxes> out{};
  for (std::size_t axis = 0; axis < kAxes; ++axis) out[axis] = std::sqrt(variance_[axis]);
  return out;
}

std::optional<SlowError::Grown> SlowError::grown() const {
  const std::size_t worse = variance_[1] > variance_[0] ? 1 : 0;
  if (!(variance_[worse] > said_[worse])) return std::nullopt;
  return Grown{std::sqrt(variance_[worse]), std::sqrt(said_[worse])};
}

double SlowError::share_of(int state, double variance, const ErrorFilter& filter) const {
  // (GATE-13)
  constexpr double kWorthIt = 1.2;  // of the variance: a tenth of the sigma
  const double until_now = variance_[axis_of(state)];
  if (!(until_now > 0.0) || !(variance > kWorthIt * until_now)) return 0.0;
  const double taken_back = 1.0 / until_now - 1.0 / variance;
  return taken_back / (1.0 - taken_back * filter(state, state));
}

void SlowError::drive(const StateDrift& drift, double dt_s, ErrorFilter& covariance) const {
  for (int i = first_; has(i); ++i) {
    const std::size_t axis = axis_of(i);
    if (!(variance_[axis] > said_[axis])) continue;
    covariance.widen(i, (variance_[axis] / said_[axis] - 1.0) * drift.walk(i) * dt_s);
  }
}

}  // namespace fathom::estimation
