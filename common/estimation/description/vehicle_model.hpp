#pragma once

// Description of the vehicle's own dynamics as a virtual velocity log.

#include "base/field.hpp"
#include "base/units.hpp"
#include "estimation/engine_config.hpp"

namespace fathom::estimation {

namespace hydro {

template <template <class> class Walk>
void describe(Walk<HydroCoefficients>& s) {
  for (const auto& one : coefficient_table())
    s.field(one.name, one.member, to_string(one.kind)).unit(one.unit);
}

}  // namespace hydro

template <template <class> class Walk>
void describe(Walk<VehicleModelConfig>& s) {
  using C = VehicleModelConfig;
  s.field("enabled", &C::enabled,
          "shaft speed and fins predict the velocity through the water; needs the state "
          "groups current and model_bias");
  s.field("coefficients_file", &C::coefficients_file,
          "file of the coefficients, relative to this file, e.g. \"hydro/remus100.json\"; empty: as given in "
          "coefficients");
  s.field("coefficients", &C::coefficients, "coefficients of the vehicle where no file is named");
  s.field("origin_B_m", &C::origin_B_m,
          "origin of the coefficients (the hull's centre of buoyancy) from the inertial unit, forward, "
          "right, down")
      .unit("m")
      .range(-1000, 1000);
  s.field("sigma_m_s", &C::sigma_m_s, "error ahead and across that is neither scale nor slow bias")
      .unit("m/s")
      .range(1e-4, 10);
  s.field("correlation_time_s", &C::correlation_time_s, "correlation time of that error")
      .unit("s")
      .range(0.01, 1000);
  s.field("fins_timeout_s", &C::fins_timeout_s, "without fin angles the velocity across counts less")
      .unit("s")
      .range(0.05, 1e6);
  s.field("min_depth_m", &C::min_depth_m,
          "the model is not used above this depth, for it is of the submerged vehicle; 0: it is used always")
      .unit("m")
      .range(-1000, 12'000);
  s.field("settle_s", &C::settle_s,
          "the model is not used before this time: it starts without knowing the current, and what was wrong "
          "dies "
          "out with the vehicle's own time constant")
      .unit("s")
      .range(0, 1e6);
  s.field("memory_s", &C::memory_s, "time over which it is compared with the DVL-aided velocity")
      .unit("s")
      .range(1, 1e6);
  s.field("trial_s", &C::trial_s, "time of comparison before it is believed without the DVL")
      .unit("s")
      .range(0, 1e6);
  s.field("doubt_limit", &C::doubt_limit, "mean normalised squared innovation above which it is not believed")
      .range(1, 100);
}

}  // namespace fathom::estimation
