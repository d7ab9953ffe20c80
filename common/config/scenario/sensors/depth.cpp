#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

template <>
void describe(Schema<sim::SimulatedSensor<DepthSample>>& s) {
  using C = sim::DepthConfig;
  common_fields(s);
  s.field("bias_sigma_m", &C::bias_sigma_m, "drawn once a run").unit("m").range(0, 100);
  s.field("sigma_m", &C::sigma_m, "white error").unit("m").range(0, 100);
  s.field("wet_only", &C::wet_only, "switched on by the water: silent in the air");
  s.field("quantum_m", &C::quantum_m, "resolution").unit("m").range(0, 10);
  s.field("outlier_m", &C::outlier_m, "size of a wrong depth").unit("m").range(0, 1e4);
}

}  // namespace fathom::config
