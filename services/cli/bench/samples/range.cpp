#include "cli/bench/samples.hpp"

namespace fathom::cli {

template <>
RangeSample bench_sample(std::string_view /*model*/, const geo::Geodetic& at) {
  RangeSample s;
  s.range_m = 128.0;
  s.sigma_m = 1.0;
  s.beacon_latitude_rad = at.latitude_rad + 2e-5;
  s.beacon_longitude_rad = at.longitude_rad;
  s.beacon_depth_m = 20.0;
  return s;
}

}  // namespace fathom::cli
