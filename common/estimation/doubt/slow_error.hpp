#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "estimation/filter/error_filter.hpp"
#include "estimation/filter/state_drift.hpp"

namespace fathom::estimation {

/// How large the slow error is of an instrument's fixes along north, east and, where that is a state, down,
/// or of a heading (GATE-13); in the units of its states. It begins as configured and grows where they
/// scatter by less than their sigma: what does not scatter is slow. The filter's states of it are driven
/// accordingly. It never shrinks but by begin(): a GPS receiver that states less shows less of it
/// (AID-GPSP-3).
class SlowError {
 public:
  static constexpr std::size_t kAxes = 3;

  /// Of the states of `group`, where there are any; `sigma`: by state, as configured.
  SlowError(const StateIndex& index, Group group, const std::array<double, kMaxStates>& sigma);

  /// From a start on: as configured.
  void begin() { variance_ = said_; }

  /// Zero where there is no state of it.
  [[nodiscard]] std::array<double, kAxes> sigma() const;
  struct Grown {
    double sigma = 0.0;
    double configured = 0.0;
  };
  /// Of the worse of north and east, where that is more than is configured.
  [[nodiscard]] std::optional<Grown> grown() const;
  [[nodiscard]] bool has(int state) const { return state >= first_ && state < first_ + axes_; }
  /// By what P grows per square of the state's column where its variance becomes `variance`, as if it had
  /// been that from the start; 0 where that is not worth it. Precondition: has(state).
  [[nodiscard]] double share_of(int state, double variance, const ErrorFilter& filter) const;
  /// Precondition: has(state).
  void grow(int state, double variance) { variance_[axis_of(state)] = variance; }
  /// Adds to `covariance` what drives it in `dt_s` beside `drift`, which is that of the configured one.
  void drive(const StateDrift& drift, double dt_s, ErrorFilter& covariance) const;

  /// For archives: see fields/doubt.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  [[nodiscard]] std::size_t axis_of(int state) const { return static_cast<std::size_t>(state - first_); }

  int first_ = 0;
  int axes_ = 0;  ///< 0: there are no such states
  std::array<double, kAxes> said_{};
  std::array<double, kAxes> variance_{};
};

}  // namespace fathom::estimation
