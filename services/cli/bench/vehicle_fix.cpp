#include "cli/bench/vehicle.hpp"

namespace fathom::cli {

void BenchVehicle::carry_transponder() {
  config_.sensors.push_back(estimation::default_sensor(SourceKind::usbl, "usbl0"));
}

UsblSample BenchVehicle::late_fix(double late_s) const {
  UsblSample usbl;
  usbl.header = header("usbl0", now_ns_ - from_seconds(late_s));
  const geo::Geodetic at = position(usbl.header.stamp_ns);
  usbl.latitude_rad = at.latitude_rad;
  usbl.longitude_rad = at.longitude_rad;
  usbl.depth_m = 20.0;
  usbl.sigma_m = 2.0;
  return usbl;
}

}  // namespace fathom::cli
