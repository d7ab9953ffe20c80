#include "study/instruments.hpp"

#include <cmath>

namespace fathom::study {

sim::ImuConfig simulated(const ImuGrade& grade, double real) {
  sim::ImuConfig imu;
  imu.enabled = true;
  imu.rate_hz = 100.0;
  imu.gyro.bias_sigma = real * grade.gyro_bias_rad_s;
  imu.gyro.instability_sigma = real * grade.gyro_in_run_rad_s;
  imu.gyro.instability_tau_s = grade.in_run_s;
  imu.gyro.random_walk = real * grade.angle_walk_rad_sqrt_s;
  imu.gyro.scale_sigma = real * grade.gyro_scale;
  imu.gyro.misalignment_sigma_rad = real * grade.misalignment_rad;
  imu.accelerometer.bias_sigma = real * grade.accel_bias_m_s2;
  imu.accelerometer.instability_sigma = real * grade.accel_in_run_m_s2;
  imu.accelerometer.instability_tau_s = grade.in_run_s;
  imu.accelerometer.random_walk = real * grade.velocity_walk_m_s_sqrt_s;
  imu.accelerometer.scale_sigma = real * grade.accel_scale;
  imu.accelerometer.misalignment_sigma_rad = real * grade.misalignment_rad;
  return imu;
}

void tell(estimation::ImuConfig& imu, const ImuGrade& grade, ImuModelling modelling) {
  imu.angle_random_walk_rad_sqrt_s = grade.angle_walk_rad_sqrt_s;
  imu.velocity_random_walk_m_s_sqrt_s = grade.velocity_walk_m_s_sqrt_s;
  imu.gyro_bias_sigma_rad_s = grade.gyro_bias_rad_s;
  imu.gyro_bias_instability_rad_s = grade.gyro_in_run_rad_s;
  imu.gyro_bias_time_constant_s = grade.in_run_s;
  imu.accel_bias_sigma_m_s2 = grade.accel_bias_m_s2;
  imu.accel_bias_instability_m_s2 = grade.accel_in_run_m_s2;
  imu.accel_bias_time_constant_s = grade.in_run_s;
  const double told = modelling == ImuModelling::everything ? 1.0 : 0.0;
  imu.gyro_scale_sigma = told * grade.gyro_scale;
  imu.accel_scale_sigma = told * grade.accel_scale;
  imu.gyro_misalignment_sigma_rad = told * grade.misalignment_rad;
  imu.accel_misalignment_sigma_rad = told * grade.misalignment_rad;
  imu.gyro_g_sensitivity_rad_s_per_m_s2 = told * grade.gyro_g_sensitivity_rad_s_per_m_s2;
}

sim::DvlConfig simulated(const DvlNoise& noise, double real) {
  sim::DvlConfig dvl;
  dvl.enabled = true;
  dvl.beam_angle_rad = kBeam_rad;
  dvl.beam_sigma_m_s = real * noise.beam_m_s;
  dvl.beam_sigma_per_speed = real * noise.beam_per_speed;
  return dvl;
}

estimation::SensorConfig told(const DvlNoise& noise, const std::array<double, 3>& lever_B_m) {
  auto dvl = estimation::default_sensor(SourceKind::dvl, "dvl");
  dvl.lever_B_m = lever_B_m;
  const double level = 1.0 / (std::numbers::sqrt2 * std::sin(kBeam_rad));
  const double down = 1.0 / (2.0 * std::cos(kBeam_rad));
  dvl.sigma = {level * noise.beam_m_s, level * noise.beam_m_s, down * noise.beam_m_s};
  dvl.proportional_sigma = level * noise.beam_per_speed;
  dvl.frozen_change = 0.0;  // at constant speed readings may well repeat
  return dvl;
}

void believe_everything(estimation::SensorConfig& sensor) {
  sensor.robust = estimation::RobustKind::none;
  sensor.gate_probability = 1.0;
}

}  // namespace fathom::study
