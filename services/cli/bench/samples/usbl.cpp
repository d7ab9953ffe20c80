#include "cli/bench/samples.hpp"

namespace fathom::cli {

template <>
UsblSample bench_sample(std::string_view model, const geo::Geodetic& at) {
  UsblSample s;
  s.sigma_m = 2.0;
  s.station_latitude_rad = at.latitude_rad + 2e-5;
  s.station_longitude_rad = at.longitude_rad;
  s.station_depth_m = 5.0;
  s.station_rpy_rad = {0.02, -0.01, 1.0};
  if (model == "usbl_position") {
    s.latitude_rad = at.latitude_rad;
    s.longitude_rad = at.longitude_rad;
    s.depth_m = 20.0;
    return s;
  }
  s.frame = UsblFrame::vessel_frd;
  if (model == "usbl_vector") {
    s.relative_m = {-60.0, 100.0, 15.0};
    return s;
  }
  s.range_m = 128.0;
  s.bearing_rad = 2.1;
  s.depression_rad = 0.12;
  return s;
}

}  // namespace fathom::cli
