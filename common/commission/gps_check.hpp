#pragma once

#include <Eigen/Core>

#include "commission/finding.hpp"
#include "commission/fit/series.hpp"

namespace fathom::commission {

/// The velocity of a receiver against the change of its own position: axes, signs, unit.
struct GpsCheck {
  Findings findings;
  bool usable = false;     ///< there is a velocity, given or made from positions
  GpsVelocity velocity_N;  ///< corrected; from positions where there was none
  double sigma_m_s = 0.1;  ///< of one component, from the second differences of the velocity or positions
  bool from_positions = false;
};
[[nodiscard]] GpsCheck check_gps(const Series& series);

}  // namespace fathom::commission
