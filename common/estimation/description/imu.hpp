#pragma once

// Description of the error model of the inertial unit.

#include "base/field.hpp"
#include "base/units.hpp"
#include "estimation/engine_config.hpp"

namespace fathom::estimation {

template <template <class> class Walk>
void describe(Walk<ImuConfig>& s) {
  using C = ImuConfig;
  s.field("rate_convention", &C::rate_convention, "what a rate without increments means")
      .words({{"interval_mean", RateConvention::interval_mean}, {"point", RateConvention::point}});
  s.field("mounting_rpy_deg", &C::mounting_rpy_rad, "roll, pitch, yaw of the unit's axes in the body frame")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("nominal_rate_hz", &C::nominal_rate_hz,
          "expected rate: sizes the history and the output's deadline")
      .unit("Hz")
      .range(1, 2000);
  s.field("max_noise_factor", &C::max_noise_factor,
          "where the motion strays more than the white noise makes of it, that counts up to so many times; "
          "1: as said")
      .range(1, 100);
  s.field("angle_random_walk_deg_sqrt_h", &C::angle_random_walk_rad_sqrt_s, "gyro white noise")
      .unit("deg/sqrt(h)")
      .range(1e-6, 1000)
      .scaled(kRadPerDeg * kPerSqrtHour_per_sqrt_s);
  s.field("velocity_random_walk_m_s_sqrt_h", &C::velocity_random_walk_m_s_sqrt_s, "accelerometer white noise")
      .unit("m/s/sqrt(h)")
      .range(1e-6, 600)
      .scaled(kPerSqrtHour_per_sqrt_s);
  s.field("gyro_bias_sigma_deg_h", &C::gyro_bias_sigma_rad_s, "gyro turn-on bias")
      .unit("deg/h")
      .range(1e-6, 1e5)
      .scaled(kDegPerHour_rad_s);
  s.field("gyro_bias_instability_deg_h", &C::gyro_bias_instability_rad_s,
          "in-run drift of the gyro bias: steady state of its Gauss-Markov process")
      .unit("deg/h")
      .range(0, 1e5)
      .scaled(kDegPerHour_rad_s);
  s.field("gyro_bias_time_constant_s", &C::gyro_bias_time_constant_s, "time constant of that process")
      .unit("s")
      .range(1, 1e9);
  s.field("accel_bias_sigma_m_s2", &C::accel_bias_sigma_m_s2, "accelerometer turn-on bias")
      .unit("m/s^2")
      .range(1e-9, 10);
  s.field("accel_bias_instability_m_s2", &C::accel_bias_instability_m_s2,
          "in-run drift of the accelerometer bias: steady state of its Gauss-Markov process")
      .unit("m/s^2")
      .range(0, 10);
  s.field("accel_bias_time_constant_s", &C::accel_bias_time_constant_s, "time constant of that process")
      .unit("s")
      .range(1, 1e9);
  s.field(
       "gyro_bias_settling_deg_h", &C::gyro_bias_settling_rad_s,
       "what the gyro biases move by, beyond the in-run drift, while the unit settles after navigation has "
       "begun: warming up, or a filter inside the instrument that still changes its corrections; 0: settled")
      .unit("deg/h")
      .range(0, 1e5)
      .scaled(kDegPerHour_rad_s);
  s.field("accel_bias_settling_m_s2", &C::accel_bias_settling_m_s2,
          "what the accelerometer biases move by meanwhile; 0: settled")
      .unit("m/s^2")
      .range(0, 10);
  s.field("bias_settling_time_s", &C::bias_settling_time_s, "time constant in which the settling dies out")
      .unit("s")
      .range(0.1, 1e6);
  s.field("gyro_scale_sigma", &C::gyro_scale_sigma,
          "gyro scale error, a ratio; where the state group gyro_scale is off it is considered, or noise "
          "(left_out)")
      .range(0, 0.1);
  s.field("accel_scale_sigma", &C::accel_scale_sigma,
          "accelerometer scale error, a ratio; where the state group accel_scale is off it is considered, or "
          "noise (left_out)")
      .range(0, 0.1);
  s.field("gyro_misalignment_sigma_deg", &C::gyro_misalignment_sigma_rad,
          "misalignment between the gyro axes; where its state group is off it is considered, or noise "
          "(left_out)")
      .unit("deg")
      .range(0, 5)
      .scaled(kRadPerDeg);
  s.field("accel_misalignment_sigma_deg", &C::accel_misalignment_sigma_rad,
          "misalignment between the accelerometer axes; where its state group is off it is considered, or "
          "noise (left_out)")
      .unit("deg")
      .range(0, 5)
      .scaled(kRadPerDeg);
  s.field("gyro_g_sensitivity_deg_h_g", &C::gyro_g_sensitivity_rad_s_per_m_s2,
          "what a gyro turns by for a specific force, per axis; it counts as noise")
      .unit("deg/h/g")
      .range(0, 5000)
      .scaled(kDegPerHour_rad_s / kStandardGravity_m_s2);
  s.field(
       "accel_nonlinearity_sigma", &C::accel_nonlinearity_sigma,
       "accelerometer error that grows with the acceleration but is no constant scale, a ratio; it counts as "
       "noise")
      .range(0, 0.1);
  s.field("equivalent_noise_time_s", &C::equivalent_noise_time_s,
          "correlation time of the errors above that count as noise")
      .unit("s")
      .range(0, 100);
  s.field("max_rate_deg_s", &C::max_rate_rad_s, "larger rates are out of range")
      .unit("deg/s")
      .range(6, 57'000)
      .scaled(kRadPerDeg);
  s.field("max_specific_force_m_s2", &C::max_specific_force_m_s2, "larger specific forces are out of range")
      .unit("m/s^2")
      .range(15, 1e5);
  s.field("max_gap_s", &C::max_gap_s, "longer gaps widen the uncertainty").unit("s").range(1e-3, 10);
  s.field("lost_gap_s", &C::lost_gap_s, "after longer gaps the attitude is lost").unit("s").range(1e-3, 3600);
  s.field("gap_rate_sigma_deg_s", &C::gap_rate_sigma_rad_s, "turning assumed possible in a gap")
      .unit("deg/s")
      .range(0, 570)
      .scaled(kRadPerDeg);
  s.field("gap_acceleration_sigma_m_s2", &C::gap_acceleration_sigma_m_s2,
          "acceleration assumed possible in a gap")
      .unit("m/s^2")
      .range(0, 100);
}

}  // namespace fathom::estimation
