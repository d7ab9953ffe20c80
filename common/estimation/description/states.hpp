#pragma once

// Description of which states are estimated, and how uncertain they are at the start.

#include "base/field.hpp"
#include "base/units.hpp"
#include "estimation/engine_config.hpp"

namespace fathom::estimation {

template <template <class> class Walk>
void describe(Walk<StateGroups>& s) {
  using C = StateGroups;
  s.field("accel_scale", &C::accel_scale, "accelerometer scale, 3 states");
  s.field("gyro_scale", &C::gyro_scale, "gyro scale, 3 states");
  s.field("accel_misalignment", &C::accel_misalignment, "accelerometer misalignment, 6 states");
  s.field("gyro_misalignment", &C::gyro_misalignment, "gyro misalignment, 6 states");
  s.field("dvl_scale", &C::dvl_scale, "one DVL scale for all axes");
  s.field("dvl_scale_xyz", &C::dvl_scale_xyz, "DVL scale per axis, 3 states; excludes dvl_scale");
  s.field("dvl_misalignment", &C::dvl_misalignment, "DVL misalignment, 3 states");
  s.field("dvl_bias", &C::dvl_bias, "DVL bias, 3 states");
  s.field("current", &C::current, "velocity of the medium north and east, 2 states");
  s.field("depth_bias", &C::depth_bias, "depth bias");
  s.field("surface_altitude", &C::surface_altitude, "ellipsoidal height of the water surface");
  s.field("heading_bias", &C::heading_bias, "compass bias");
  s.field("heading_deviation", &C::heading_deviation, "compass deviation B to E, 4 states");
  s.field("usbl_bias", &C::usbl_bias, "USBL bias north and east, 2 states");
  s.field("usbl_misalignment", &C::usbl_misalignment, "misalignment of the USBL transceiver, 3 states");
  s.field("gps_position_bias", &C::gps_position_bias, "correlated GPS position error, 3 states");
  s.field("gps_latency", &C::gps_latency, "GPS latency beyond the configured one");
  s.field("gps_lever", &C::gps_lever, "place of the GPS antenna beyond the configured one, 3 states");
  s.field("log_scale", &C::log_scale, "scale of the speed log made from propulsor speed");
  s.field("airspeed_bias", &C::airspeed_bias, "bias of the airspeed");
  s.field("airspeed_scale", &C::airspeed_scale, "scale of the airspeed");
  s.field("flow_angles", &C::flow_angles, "sideslip and angle of attack, 2 states");
  s.field("baro_bias", &C::baro_bias, "barometric height less ellipsoidal height");
  s.field("mount_angles", &C::mount_angles,
          "pitch and yaw of the axes of the non-holonomic constraint beyond the configured ones, 2 states");
  s.field("model_scale", &C::model_scale,
          "share by which the vehicle model errs, ahead and across, 2 states");
  s.field("model_bias", &C::model_bias,
          "slow error of the vehicle model's velocity, ahead and across, 2 states");
  s.field("antenna_bias", &C::antenna_bias, "slow error of a heading by two antennas");
  s.field("beacon_place", &C::beacon_place,
          "by what each of the first three beacons lies elsewhere than it is said to, 6 states");
  s.field("mount_lever", &C::mount_lever,
          "place of the non-holonomic constraint beyond the configured one, 3 states");
}

template <template <class> class Walk>
void describe(Walk<StateModelConfig>& s) {
  using C = StateModelConfig;
  s.field("vertical_deflection_sigma_deg", &C::vertical_deflection_sigma_rad,
          "deflection of the vertical along each axis: what is published as the sigma of roll and pitch "
          "includes "
          "it; the default is the 7 arcsec of a global gravity model, mountains and trenches have 30")
      .unit("deg")
      .range(0, 0.1)
      .scaled(kRadPerDeg);
  s.field(
       "mounting_sigma_deg", &C::mounting_sigma_rad,
       "how well the unit's axes in the vehicle are known: what is published as the sigma of roll and pitch "
       "includes it; 0: the vehicle's axes are the unit's, as configured. A plate bolted true to a "
       "millimetre in "
       "a metre is 0.05, a board in a box by hand 0.5")
      .unit("deg")
      .range(0, 10)
      .scaled(kRadPerDeg);
  s.field("dvl_scale_sigma", &C::dvl_scale_sigma, "DVL scale error, a ratio").range(1e-6, 1);
  s.field("dvl_misalignment_sigma_deg", &C::dvl_misalignment_sigma_rad, "DVL misalignment about each axis")
      .unit("deg")
      .range(1e-4, 57)
      .scaled(kRadPerDeg);
  s.field("dvl_bias_sigma_m_s", &C::dvl_bias_sigma_m_s,
          "DVL bias along each axis, the part of the data sheet's long-term accuracy that does not grow with "
          "the "
          "speed; 0: none")
      .unit("m/s")
      .range(0, 10);
  s.field("current_sigma_m_s", &C::current_sigma_m_s, "each component of the velocity of the medium")
      .unit("m/s")
      .range(1e-6, 100);
  s.field("current_time_constant_s", &C::current_time_constant_s,
          "time constant of the velocity of the medium; 0: it does not change")
      .unit("s")
      .range(0, 1e9);
  s.field("depth_bias_sigma_m", &C::depth_bias_sigma_m, "depth bias").unit("m").range(1e-6, 100);
  s.field("surface_altitude_m", &C::surface_altitude_m,
          "ellipsoidal height of the water surface, where it is not estimated or as its start")
      .unit("m")
      .range(-500, 9000);
  s.field("surface_altitude_sigma_m", &C::surface_altitude_sigma_m, "uncertainty of that height")
      .unit("m")
      .range(1e-6, 1e4);
  s.field("surface_altitude_walk_m_sqrt_s", &C::surface_altitude_walk_m_sqrt_s, "tide, as a random walk")
      .unit("m/sqrt(s)")
      .range(0, 1);
  s.field("heading_bias_sigma_deg", &C::heading_bias_sigma_rad, "compass bias")
      .unit("deg")
      .range(1e-4, 170)
      .scaled(kRadPerDeg);
  s.field("heading_bias_time_constant_s", &C::heading_bias_time_constant_s,
          "time constant of the compass bias, since deviation changes with course; 0: it is constant")
      .unit("s")
      .range(0, 1e9);
  s.field("heading_deviation_sigma_deg", &C::heading_deviation_sigma_rad,
          "each coefficient of the compass deviation")
      .unit("deg")
      .range(1e-4, 170)
      .scaled(kRadPerDeg);
  s.field("usbl_bias_sigma_m", &C::usbl_bias_sigma_m, "each component of the USBL bias")
      .unit("m")
      .range(1e-6, 1e4);
  s.field("beacon_place_sigma_m", &C::beacon_place_sigma_m,
          "how far beacons lie from where they are said to, north and east; found by ranges from a boat with "
          "GPS it is a metre or two, by a ship's calibrated USBL and RTK a few decimetres")
      .unit("m")
      .range(1e-6, 1e4);
  s.field("gps_bias_sigma_m", &C::gps_bias_sigma_m,
          "correlated GPS error, each horizontal component, at least; the vertical one is twice it")
      .unit("m")
      .range(1e-6, 100);
  s.field("gps_bias_time_constant_s", &C::gps_bias_time_constant_s,
          "time constant of the correlated GPS error")
      .unit("s")
      .range(1, 1e9);
  s.field("usbl_misalignment_sigma_deg", &C::usbl_misalignment_sigma_rad, "USBL misalignment about each axis")
      .unit("deg")
      .range(1e-4, 57)
      .scaled(kRadPerDeg);
  s.field("gps_latency_sigma_s", &C::gps_latency_sigma_s, "GPS latency beyond the configured one")
      .unit("s")
      .range(1e-6, 10);
  s.field("gps_lever_sigma_m", &C::gps_lever_sigma_m, "each component of the place of the GPS antenna")
      .unit("m")
      .range(1e-6, 100);
  s.field("log_scale_sigma", &C::log_scale_sigma, "scale error of the speed log, a ratio").range(1e-6, 1);
  s.field("airspeed_bias_sigma_m_s", &C::airspeed_bias_sigma_m_s, "airspeed bias")
      .unit("m/s")
      .range(1e-6, 100);
  s.field("airspeed_scale_sigma", &C::airspeed_scale_sigma, "airspeed scale error, a ratio").range(1e-6, 1);
  s.field("flow_angle_sigma_deg", &C::flow_angle_sigma_rad, "sideslip and angle of attack")
      .unit("deg")
      .range(1e-4, 57)
      .scaled(kRadPerDeg);
  s.field("flow_angle_time_constant_s", &C::flow_angle_time_constant_s,
          "time constant of sideslip and angle of attack")
      .unit("s")
      .range(1e-2, 1e9);
  s.field("baro_bias_sigma_m", &C::baro_bias_sigma_m, "barometric height less ellipsoidal height")
      .unit("m")
      .range(1e-6, 1e4);
  s.field("baro_bias_walk_m_sqrt_s", &C::baro_bias_walk_m_sqrt_s,
          "weather and the instrument's drift, as a random walk")
      .unit("m/sqrt(s)")
      .range(0, 100);
  s.field("mount_angle_sigma_deg", &C::mount_angle_sigma_rad, "pitch and yaw of the wheels' axes")
      .unit("deg")
      .range(1e-4, 57)
      .scaled(kRadPerDeg);
  s.field("model_scale_sigma", &C::model_scale_sigma, "share by which the vehicle model errs, a ratio")
      .range(1e-6, 1);
  s.field("model_bias_sigma_m_s", &C::model_bias_sigma_m_s,
          "each component of the vehicle model's slow error")
      .unit("m/s")
      .range(1e-6, 10);
  s.field("model_bias_time_constant_s", &C::model_bias_time_constant_s, "time constant of that slow error")
      .unit("s")
      .range(1, 1e9);
  s.field("mount_lever_sigma_m", &C::mount_lever_sigma_m, "each component of the place of the constraint")
      .unit("m")
      .range(1e-6, 100);
}

}  // namespace fathom::estimation
