#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

template <>
void describe(Schema<sim::SimulatedSensor<FinsSample>>& s) {
  common_fields(s);
  s.field("sigma_deg", &sim::FinsConfig::sigma_rad, "white error")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0, 90);
  s.field("bias_sigma_deg", &sim::FinsConfig::bias_sigma_rad, "drawn once a run")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0, 90);
}

}  // namespace fathom::config
