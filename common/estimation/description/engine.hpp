#pragma once

// Description of the whole estimator.

#include "base/field.hpp"
#include "base/units.hpp"
#include "estimation/description/air_drop.hpp"
#include "estimation/description/alignment.hpp"
#include "estimation/description/altimeter.hpp"
#include "estimation/description/constraints.hpp"
#include "estimation/description/imu.hpp"
#include "estimation/description/sensor.hpp"
#include "estimation/description/states.hpp"
#include "estimation/description/vehicle_model.hpp"
#include "estimation/engine_config.hpp"

namespace fathom::estimation {

template <template <class> class Walk>
void describe(Walk<ForecastLimitConfig>& s) {
  s.field("name", &ForecastLimitConfig::name,
          "name of the limit; one that begins with \"heading\" limits the heading, others the position")
      .name()
      .required();
  s.field("limit", &ForecastLimitConfig::limit, "limit of the 95 % uncertainty: m, or rad for a heading")
      .range(1e-6, 1e7)
      .required();
}

[[nodiscard]] inline std::vector<std::pair<std::string, std::string>> state_configuration_words() {
  std::vector<std::pair<std::string, std::string>> out;
  for (const StateConfiguration& one : state_configurations()) out.emplace_back(one.name, one.name);
  return out;
}

template <template <class> class Walk>
void describe(Walk<EngineConfig>& s) {
  using C = EngineConfig;
  s.field("configuration", &C::configuration, "named set of estimated states")
      .words(state_configuration_words());
  s.field("groups", &C::groups, "state groups switched on or off against the named set");
  s.field(
       "left_out", &C::left_out,
       "what becomes of errors that no state is estimated for: scale and misalignment of inertial unit and "
       "DVL, the bias of DVL and compass, the slow error of GPS, USBL and a heading by two antennas, the "
       "places of beacons; considered in the covariance, or noise of the inertial unit and else none")
      .words({{"considered", LeftOut::considered}, {"noise", LeftOut::noise}});
  s.field("imu", &C::imu, "error model of the inertial unit").required();
  s.field("states", &C::states, "initial uncertainty and drift of the states beyond the core");
  s.field("sensors", &C::sensors, "aiding instruments; one that is not listed is never used").required();
  s.field("alignment", &C::alignment, "finding the attitude");
  s.field("air_drop", &C::air_drop, "finding roll and pitch under way after a drop");
  s.field("vehicle_model", &C::vehicle_model,
          "the vehicle's own dynamics as a virtual velocity log, for when the DVL is lost");
  s.field("constraints", &C::constraints, "what is known about the motion without an instrument");
  s.field("horizon_s", &C::horizon_s, "measurements up to this late give the same bits as punctual ones")
      .unit("s")
      .range(0.1, 60);
  s.field("snapshot_interval_s", &C::snapshot_interval_s,
          "a roll-back repeats at most this much more than it must")
      .unit("s")
      .range(0.01, 60);
  s.field("replay_steps_per_sample", &C::replay_steps_per_sample,
          "steps that one inertial sample repeats for late measurements; what needs more is spread over the "
          "next")
      .range(2, 1e6);
  s.field("late_fix_memory_s", &C::late_fix_memory_s,
          "how old a fix of a sensor of kind fix may be when it is given; beyond the horizon it acts through "
          "what the filter has done since; 0: nothing is remembered beyond the horizon")
      .unit("s")
      .range(0, 7200);
  s.field("future_tolerance_s", &C::future_tolerance_s,
          "stamps further ahead of the newest inertial sample are refused")
      .unit("s")
      .range(0, 60);
  s.field("measurement_capacity", &C::measurement_capacity,
          "measurements remembered; more within the horizon shorten it")
      .range(64, 65'535);
  s.field("magnetic_variation_known", &C::magnetic_variation_known, "magnetic_variation_deg is to be used");
  s.field("magnetic_variation_deg", &C::magnetic_variation_rad,
          "magnetic variation, east positive, used where the compass reports none")
      .unit("deg")
      .range(-180, 180)
      .scaled(kRadPerDeg);
  s.field("gps_timeout_s", &C::gps_timeout_s, "the mode leaves gps_aided this long after the last fix")
      .unit("s")
      .range(0.1, 1e5);
  s.field("usbl_timeout_s", &C::usbl_timeout_s, "the mode leaves acoustic_aided this long after the last fix")
      .unit("s")
      .range(0.1, 1e5);
  s.field("velocity_timeout_s", &C::velocity_timeout_s,
          "the mode leaves dead_reckoning this long after the last velocity")
      .unit("s")
      .range(0.1, 1e5);
  s.field("zero_velocity_sigma_m_s", &C::zero_velocity_sigma_m_s,
          "velocity that remains while the vehicle is marked at rest")
      .unit("m/s")
      .range(1e-5, 10);
  s.field("altimeter", &C::altimeter, "height above the bottom, which is published and aids nothing");
  s.field("output_lever_B_m", &C::output_lever_B_m,
          "from the inertial unit to the point whose position and velocity are published")
      .unit("m")
      .range(-1000, 1000);
  s.field("output_axes", &C::output_axes,
          "whose attitude, rate and force are published: the body's, or, where constraints.non_holonomic is "
          "enabled, those of the wheels with the mount angles that were found")
      .words({{"body", OutputAxes::body}, {"wheels", OutputAxes::wheels}});
  s.field("forecast_span_s", &C::forecast_span_s, "how far the forecast looks").unit("s").range(1, 7200);
  s.field("forecast_limits", &C::forecast_limits, "what the forecast watches, at most 8");
}

}  // namespace fathom::estimation
