#pragma once

// Description of the altimeter, whose height is published and aids nothing.

#include "base/field.hpp"
#include "estimation/engine_config.hpp"

namespace fathom::estimation {

template <template <class> class Walk>
void describe(Walk<AltimeterConfig>& s) {
  using C = AltimeterConfig;
  s.field("sensor", &C::sensor, "name in the altimeter's samples; empty: any altimeter");
  s.field("lever_B_m", &C::lever_B_m, "from the inertial unit to the transducer, forward, right, down")
      .unit("m")
      .range(-1000, 1000);
  s.field("latency_s", &C::latency_s, "subtracted from the stamp").unit("s").range(-10, 60);
  s.field("fresh_s", &C::fresh_s, "a height that is older is not published").unit("s").range(0.1, 60);
}

}  // namespace fathom::estimation
