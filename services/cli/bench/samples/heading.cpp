#include "cli/bench/samples.hpp"

namespace fathom::cli {

template <>
HeadingSample bench_sample(std::string_view /*model*/, const geo::Geodetic& /*at*/) {
  HeadingSample s;
  s.heading_rad = 0.5;
  return s;
}

}  // namespace fathom::cli
