#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

template <>
void describe(Schema<sim::SimulatedSensor<PropulsionSample>>& s) {
  common_fields(s);
  s.field("sigma_rpm", &sim::PropulsionConfig::sigma_rpm, "white error").unit("rpm").range(0, 1e4);
  s.field("scale_sigma", &sim::PropulsionConfig::scale_sigma, "scale error, drawn once a run").range(0, 1);
}

}  // namespace fathom::config
