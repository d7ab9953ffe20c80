#pragma once

#include "geo/wgs84.hpp"
#include "samples/heading.hpp"

namespace fathom::sim::encode {

/// As a pair of antennas says it, [0, 2 pi): a magnetic heading by its variation. Unknown without that.
[[nodiscard]] inline double true_heading_rad(const HeadingSample& sample) {
  const double to_true_rad = sample.north == North::magnetic ? sample.variation_rad : 0.0;
  return geo::wrap_two_pi(sample.heading_rad + to_true_rad);
}

}  // namespace fathom::sim::encode
