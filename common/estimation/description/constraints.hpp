#pragma once

// Description of what is known about the motion without an instrument.

#include "base/field.hpp"
#include "base/units.hpp"
#include "estimation/engine_config.hpp"

namespace fathom::estimation {

template <template <class> class Walk>
void describe(Walk<NonHolonomicConfig>& s) {
  using C = NonHolonomicConfig;
  s.field(
      "enabled", &C::enabled,
      "the vehicle runs on wheels: no velocity sideways and upwards; groups accel_scale, mount_angles and "
      "mount_lever are then estimated where nothing else is said");
  s.field("rate_hz", &C::rate_hz, "how often it is applied").unit("Hz").range(0.01, 1000);
  s.field("lever_B_m", &C::lever_B_m, "from the inertial unit to the point where it holds, the rear axle")
      .unit("m")
      .range(-1000, 1000);
  s.field("mounting_rpy_deg", &C::mounting_rpy_rad, "roll, pitch, yaw of the wheels' axes in the body frame")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("lateral_sigma_m_s", &C::lateral_sigma_m_s, "slip sideways").unit("m/s").range(1e-5, 1e3);
  s.field("vertical_sigma_m_s", &C::vertical_sigma_m_s, "bounce upwards").unit("m/s").range(1e-5, 1e3);
  s.field("slip_time_s", &C::slip_time_s,
          "time for which slip and bounce last; 0: they are noise of each application")
      .unit("s")
      .range(0, 1000);
}

template <template <class> class Walk>
void describe(Walk<ConstantDepthConfig>& s) {
  using C = ConstantDepthConfig;
  s.field("enabled", &C::enabled, "the vehicle keeps its depth: no velocity down");
  s.field("rate_hz", &C::rate_hz, "how often it is applied").unit("Hz").range(0.01, 1000);
  s.field("sigma_m_s", &C::sigma_m_s, "velocity down that remains").unit("m/s").range(1e-5, 1e3);
}

template <template <class> class Walk>
void describe(Walk<ConstraintsConfig>& s) {
  s.field("non_holonomic", &ConstraintsConfig::non_holonomic, "a vehicle on wheels");
  s.field("constant_depth", &ConstraintsConfig::constant_depth, "a vehicle that keeps its depth");
}

}  // namespace fathom::estimation
