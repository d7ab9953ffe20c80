#include "cli/bench/samples.hpp"

namespace fathom::cli {

template <>
PropulsionSample bench_sample(std::string_view /*model*/, const geo::Geodetic& /*at*/) {
  PropulsionSample s;
  s.rpm = 1000.0;
  return s;
}

template <>
FinsSample bench_sample(std::string_view /*model*/, const geo::Geodetic& /*at*/) {
  FinsSample s;
  s.rudder_rad = 0.05;
  s.stern_rad = 0.02;
  return s;
}

}  // namespace fathom::cli
