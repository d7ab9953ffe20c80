#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/unknown.hpp"
#include "dataset/score.hpp"
#include "samples/nav_state.hpp"

namespace fathom::cli {

/// What part of the horizontal error is of the reference's clock and of its point on the vehicle: such an
/// error goes with the velocity and turns with the vehicle. A filter that finds the latency and the antenna
/// of a receiver differs by it from a reference that is made of the same fixes.
struct Placement {
  std::size_t count = 0;
  double reference_late_s = kUnknown;  ///< its stamps lie behind their positions' instants by this
  std::array<double, 2> offset_B_m{kUnknown, kUnknown};  ///< from its point to ours, forward and right
  double rms_m = kUnknown;                               ///< horizontal error that is left without both
  double nees_horizontal = kUnknown;                     ///< of what is left, mean; 2 degrees of freedom
};

class ReferencePlacement {
 public:
  void reserve(std::size_t rows) { rows_.reserve(rows); }
  void add(const NavState& state, const dataset::NavError& error);
  /// Least squares over all, with a constant error north and east beside them, which is no placement and
  /// stays in what is left. Nothing where the vehicle did not change speed and heading enough to tell.
  [[nodiscard]] Placement figures() const;

 private:
  struct Row {
    std::array<double, 2> error_N_m;
    std::array<double, 2> velocity_N_m_s;
    std::array<double, 2> heading;  ///< cosine and sine
    std::array<double, 3> p_m2;     ///< NN, NE, EE
  };
  std::vector<Row> rows_;
};

}  // namespace fathom::cli
