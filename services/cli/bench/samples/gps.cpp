#include "cli/bench/samples.hpp"

namespace fathom::cli {

template <>
GpsSample bench_sample(std::string_view /*model*/, const geo::Geodetic& at) {
  GpsSample s;
  s.fix = GpsFix::fix_3d;
  s.latitude_rad = at.latitude_rad;
  s.longitude_rad = at.longitude_rad;
  s.altitude_m = at.altitude_m;
  s.velocity_N_m_s = {1.7, 0.9, 0.0};
  return s;
}

}  // namespace fathom::cli
