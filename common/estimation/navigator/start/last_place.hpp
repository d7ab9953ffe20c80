#pragma once

#include <algorithm>
#include <cmath>

#include "estimation/navigator/estimate.hpp"

namespace fathom::estimation {

/// Where navigation was last: a start that nothing newer places begins there (ALN-22).
struct LastPlace {
  TimeNs seen_ns = 0;      ///< 0: it has never navigated
  geo::Geodetic position;  ///< of the IMU
  double surface_altitude_m = 0.0;
  double surface_sigma_m = 0.0;
  Eigen::Vector3d sigma_N_m = Eigen::Vector3d::Zero();
  double speed_m_s = 0.0;

  /// Precondition: `estimate` navigates.
  void see(const Setup& setup, const Estimate& estimate) {
    const ErrorFilter& filter = estimate.filter;
    seen_ns = estimate.now_ns;
    position = estimate.state.nav.position;
    const StateModelConfig& states = setup.config.states;
    const int surface = setup.index.of(Group::surface_altitude);
    surface_altitude_m =
        surface < 0 ? states.surface_altitude_m : estimate.state.x[static_cast<std::size_t>(surface)];
    surface_sigma_m =
        surface < 0 ? states.surface_altitude_sigma_m : std::sqrt(std::max(filter(surface, surface), 0.0));
    for (int i = 0; i < 3; ++i) sigma_N_m(i) = std::sqrt(std::max(filter(i, i), 0.0));
    speed_m_s = std::sqrt(estimate.state.nav.v_N_m_s.squaredNorm() + std::max(filter(3, 3), 0.0) +
                          std::max(filter(4, 4), 0.0) + std::max(filter(5, 5), 0.0));
  }
};

}  // namespace fathom::estimation
