#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

template <>
void describe(Schema<sim::SimulatedSensor<FixSample>>& s) {
  using C = sim::FixConfig;
  common_fields(s);
  s.field("sigma_m", &C::sigma_m, "white error of north and of east").unit("m").range(0.01, 1e5);
  s.field("outlier_m", &C::outlier_m, "by which a wrong one is off").unit("m").range(0, 1e6);
  s.field("minimum_depth_m", &C::minimum_depth_m, "shallower than this nobody looks")
      .unit("m")
      .range(-1e4, 1e4);
}

}  // namespace fathom::config
