#include "cli/bench/samples.hpp"

namespace fathom::cli {

template <>
DvlSample bench_sample(std::string_view model, const geo::Geodetic& /*at*/) {
  DvlSample s;
  if (model == "dvl_beams") {
    s.beam_velocity_m_s = {1.0, -1.0, 0.0, 0.0};
    s.beam_angle_rad = 0.5236;
  } else {
    s.velocity_D_m_s = {2.0, 0.1, 0.0};
  }
  return s;
}

}  // namespace fathom::cli
