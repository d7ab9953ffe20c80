#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

template <>
void describe(Schema<sim::SimulatedSensor<GpsSample>>& s) {
  using C = sim::GpsConfig;
  common_fields(s);
  s.field("position_sigma_m", &C::position_sigma_m, "white error, north and east").unit("m").range(0, 1e3);
  s.field("altitude_sigma_m", &C::altitude_sigma_m, "white error").unit("m").range(0, 1e3);
  s.field("correlated_sigma_m", &C::correlated_sigma_m, "slow error, north and east").unit("m").range(0, 1e3);
  s.field("correlated_altitude_sigma_m", &C::correlated_altitude_sigma_m, "slow error")
      .unit("m")
      .range(0, 1e3);
  s.field("correlated_tau_s", &C::correlated_tau_s, "correlation time of the slow error")
      .unit("s")
      .range(0.1, 1e6);
  s.field("velocity_sigma_m_s", &C::velocity_sigma_m_s, "north and east").unit("m/s").range(0, 100);
  s.field("velocity_down_sigma_m_s", &C::velocity_down_sigma_m_s, "down").unit("m/s").range(0, 100);
  s.field("outlier_m", &C::outlier_m, "size of a wrong fix").unit("m").range(0, 1e6);
  s.field("reacquire_s", &C::reacquire_s, "from the antenna's return to the air to a fix")
      .unit("s")
      .range(0, 600);
  s.field("antenna_clearance_m", &C::antenna_clearance_m, "least height of the antenna above the water")
      .unit("m")
      .range(-1, 10);
}

}  // namespace fathom::config
