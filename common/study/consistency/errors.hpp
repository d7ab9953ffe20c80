#pragma once

#include "samples/nav_state.hpp"
#include "study/consistency/truth_path.hpp"

namespace fathom::study {

/// Errors of a published state at one instant, each with its normalised square (NEES).
struct Errors {
  double tilt_rad = 0.0;
  double heading_rad = 0.0;
  double horizontal_m = 0.0;
  double tilt = 0.0;
  double heading = 0.0;
  double velocity = 0.0;
  double position = 0.0;
  bool covered = false;  ///< the horizontal error lies inside the 95 % radius
};

/// `covariance` is that of position, velocity and rotation along N, in this order (SI units, rad).
[[nodiscard]] Errors errors_of(const NavState& nav, const Eigen::Matrix<double, 9, 9>& covariance,
                               const Pose& truth);

}  // namespace fathom::study
