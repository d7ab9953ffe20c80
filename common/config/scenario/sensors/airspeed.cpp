#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

template <>
void describe(Schema<sim::SimulatedSensor<AirspeedSample>>& s) {
  using C = sim::AirspeedConfig;
  common_fields(s);
  s.field("scale_sigma", &C::scale_sigma, "scale error, drawn once a run").range(0, 1);
  s.field("sigma_m_s", &C::sigma_m_s, "white error").unit("m/s").range(0, 100);
  s.field("baro_sigma_m", &C::baro_sigma_m, "white error of the barometric altitude").unit("m").range(0, 1e3);
  s.field("baro_bias_sigma_m", &C::baro_bias_sigma_m, "its bias, drawn once a run").unit("m").range(0, 1e3);
}

}  // namespace fathom::config
