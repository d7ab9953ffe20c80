#pragma once

#include "estimation/aiding/model.hpp"

namespace fathom::estimation {

/// What the models of a place under water share: latitude, longitude and a depth that may not be told.

template <class Sample>
[[nodiscard]] Usable usable_place(const Sample& sample) {
  const bool placed = is_on_earth(sample.latitude_rad, sample.longitude_rad);
  const bool deep = !known(sample.depth_m) || (sample.depth_m > -50.0 && sample.depth_m < 12000.0);
  return placed && deep ? Usable::yes : Usable::out_of_range;
}

/// North and east of the estimate, and the depth below the surface: m.
template <class Sample>
[[nodiscard]] Eigen::Vector3d place_N_m(const AidingState& s, const Sample& sample) {
  const geo::Geodetic& here = s.state.nav.position;
  Eigen::Vector3d m = geo::difference_N(here, {sample.latitude_rad, sample.longitude_rad, here.altitude_m});
  m.z() = sample.depth_m;
  return m;
}

}  // namespace fathom::estimation
