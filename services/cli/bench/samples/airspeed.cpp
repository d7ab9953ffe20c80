#include "cli/bench/samples.hpp"

namespace fathom::cli {

template <>
AirspeedSample bench_sample(std::string_view /*model*/, const geo::Geodetic& /*at*/) {
  AirspeedSample s;
  s.airspeed_m_s = 20.0;
  s.baro_altitude_m = 30.0;
  return s;
}

}  // namespace fathom::cli
