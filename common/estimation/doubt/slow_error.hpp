#pragma once

#include <array>
#include <cstddef>

#include "estimation/filter/error_filter.hpp"
#include "estimation/filter/state_drift.hpp"

namespace fathom::estimation {

/// How large the slow error of GPS is along north, east and down (GATE-13). It begins as configured and grows
/// where a receiver states more than its fixes scatter by: what does not scatter is slow. The filter's state
/// of it is driven accordingly. It never shrinks but by begin(): a receiver that states less shows less of it
/// (AID-GPSP-3).
class SlowError {
 public:
  static constexpr std::size_t kAxes = 3;

  /// `first`: the state of its north component; -1: there is none. `sigma`: by state, as configured.
  SlowError(int first, const std::array<double, kMaxStates>& sigma);

  /// From a start on: as configured.
  void begin() { variance_N_m2_ = said_N_m2_; }

  /// Zero where there is no state of it.
  [[nodiscard]] std::array<double, kAxes> sigma_N_m() const;
  /// The state of one axis; -1: there is none.
  [[nodiscard]] int state_of(std::size_t axis) const {
    return first_ < 0 ? -1 : first_ + static_cast<int>(axis);
  }
  /// By what P grows per square of the state's column where its variance is larger by `more_m2`, as if it had
  /// been so from the start; 0 where that is not worth it.
  [[nodiscard]] double share_of(std::size_t axis, double more_m2, const ErrorFilter& filter) const;
  /// It is larger by so much.
  void grow(std::size_t axis, double more_m2) { variance_N_m2_[axis] += more_m2; }
  /// Adds to `covariance` what drives it in `dt_s` beside `drift`, which is that of the configured one.
  void drive(const StateDrift& drift, double dt_s, ErrorFilter& covariance) const;

  /// For archives: see fields/doubt.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  int first_;
  std::array<double, kAxes> said_N_m2_{};
  std::array<double, kAxes> variance_N_m2_{};
};

}  // namespace fathom::estimation
