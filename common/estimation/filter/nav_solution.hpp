#pragma once

#include <array>

#include "estimation/filter/state_index.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::estimation {

/// What the strapdown mechanisation integrates: the point of the IMU.
struct NavSolution {
  geo::Geodetic position;
  Eigen::Vector3d v_N_m_s = Eigen::Vector3d::Zero();  ///< relative to the Earth
  geo::Quaternion q_NB;
};

/// Everything the filter estimates. `x` holds the values of the states from index 9 on by StateIndex; the
/// first nine places, whose values live in `nav`, stay 0.
struct FilterState {
  NavSolution nav;
  std::array<double, kMaxStates> x{};
};

}  // namespace fathom::estimation
