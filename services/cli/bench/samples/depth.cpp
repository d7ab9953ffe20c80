#include "cli/bench/samples.hpp"

namespace fathom::cli {

template <>
DepthSample bench_sample(std::string_view /*model*/, const geo::Geodetic& /*at*/) {
  DepthSample s;
  s.depth_m = 20.0;
  return s;
}

}  // namespace fathom::cli
