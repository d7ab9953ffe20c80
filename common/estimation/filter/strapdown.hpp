#pragma once

#include "estimation/filter/nav_solution.hpp"

namespace fathom::estimation {

/// Inertial increments over one interval of length dt_s, along B, and those of the interval before it, as if
/// that had been of the same length.
struct Increments {
  double dt_s = 0.0;
  Eigen::Vector3d dtheta_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d dv_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d dtheta_before_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d dv_before_m_s = Eigen::Vector3d::Zero();
};

/// Rotation and velocity change over an interval after the coning, sculling and rotation corrections.
struct CorrectedIncrements {
  double dt_s = 0.0;
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  ///< of B at the end relative to B at the start
  Eigen::Vector3d dv_m_s = Eigen::Vector3d::Zero();        ///< along B at the start
};

/// Two-sample corrections (STRAP-1) for the part of the interval that is `fraction` of its length. Parts of
/// one interval chain to the whole: the rotation correction of dv grows with the square of the fraction.
[[nodiscard]] CorrectedIncrements correct(const Increments& increments, double fraction = 1.0);

/// One step of the mechanisation (STRAP-2): attitude with the frame rate at the start, Coriolis at the
/// midpoint velocity, trapezoidal position.
[[nodiscard]] NavSolution mechanise(const NavSolution& start, const CorrectedIncrements& increments);
/// The same with what the caller has already: the Earth at the start and its attitude as a matrix.
[[nodiscard]] NavSolution mechanise(const NavSolution& start, const geo::LocalEarth& earth,
                                    const Eigen::Matrix3d& C_NB, const CorrectedIncrements& increments);

}  // namespace fathom::estimation
