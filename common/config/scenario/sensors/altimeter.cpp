#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

template <>
void describe(Schema<sim::SimulatedSensor<AltimeterSample>>& s) {
  using C = sim::AltimeterConfig;
  common_fields(s);
  s.field("sigma_m", &C::sigma_m, "white error").unit("m").range(0, 100);
  s.field("minimum_range_m", &C::minimum_range_m, "along its axis").unit("m").range(0, 1e3);
  s.field("maximum_range_m", &C::maximum_range_m, "along its axis").unit("m").range(1, 1.2e4);
  s.field("outlier_m", &C::outlier_m, "size of a wrong altitude").unit("m").range(0, 1e4);
}

}  // namespace fathom::config
