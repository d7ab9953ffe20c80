#include "cli/bench/samples.hpp"

namespace fathom::cli {

template <>
FixSample bench_sample(std::string_view /*model*/, const geo::Geodetic& at) {
  FixSample s;
  s.latitude_rad = at.latitude_rad;
  s.longitude_rad = at.longitude_rad;
  s.sigma_m = 20.0;
  return s;
}

}  // namespace fathom::cli
