#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

template <>
void describe(Schema<sim::SimulatedSensor<HeadingSample>>& s) {
  using C = sim::HeadingConfig;
  common_fields(s);
  s.field("bias_sigma_deg", &C::bias_sigma_rad, "drawn once a run")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0, 180);
  s.field("sigma_deg", &C::sigma_rad, "white error").unit("deg").scaled(kRadPerDeg).range(0, 180);
  s.field("deviation_deg", &C::deviation_rad, "A, B sin, C cos, D sin 2, E cos 2 of the heading")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(-90, 90);
  s.field("magnetic", &C::magnetic, "a magnetic compass; false: true north");
  s.field("outlier_deg", &C::outlier_rad, "size of a wrong heading")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0, 180);
}

}  // namespace fathom::config
