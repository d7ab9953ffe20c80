#include "study/consistency/figures.hpp"

#include "study/instruments.hpp"

namespace fathom::study {

const InertialGrade kNavigationGrade{.gyro_bias_rad_s = 0.01 * kDegreePerHour,
                                     .gyro_in_run_rad_s = 0.003 * kDegreePerHour,
                                     .angle_walk_rad_sqrt_s = 0.002 * kDegree / 60.0,
                                     .gyro_scale = 10e-6,
                                     .gyro_misalignment_rad = 0.02e-3,
                                     .accel_bias_m_s2 = 0.05 * kMilliG,
                                     .accel_in_run_m_s2 = 0.01 * kMilliG,
                                     .velocity_walk_m_s_sqrt_s = 1e-4,
                                     .accel_scale = 50e-6,
                                     .accel_misalignment_rad = 0.02e-3,
                                     .in_run_s = 3600.0};

const InertialGrade kTacticalGrade{.gyro_bias_rad_s = 1.0 * kDegreePerHour,
                                   .gyro_in_run_rad_s = 0.3 * kDegreePerHour,
                                   .angle_walk_rad_sqrt_s = 0.1 * kDegree / 60.0,
                                   .gyro_scale = 150e-6,
                                   .gyro_misalignment_rad = 0.3e-3,
                                   .accel_bias_m_s2 = 1.0 * kMilliG,
                                   .accel_in_run_m_s2 = 0.1 * kMilliG,
                                   .velocity_walk_m_s_sqrt_s = 0.02 / 60.0,
                                   .accel_scale = 300e-6,
                                   .accel_misalignment_rad = 0.3e-3,
                                   .in_run_s = 1800.0};

const InertialGrade kIndustrialGrade{.gyro_bias_rad_s = 20.0 * kDegreePerHour,
                                     .gyro_in_run_rad_s = 3.0 * kDegreePerHour,
                                     .angle_walk_rad_sqrt_s = 0.15 * kDegree / 60.0,
                                     .gyro_scale = 1e-3,
                                     .gyro_misalignment_rad = 1e-3,
                                     .accel_bias_m_s2 = 4.0 * kMilliG,
                                     .accel_in_run_m_s2 = 0.3 * kMilliG,
                                     .velocity_walk_m_s_sqrt_s = 0.03 / 60.0,
                                     .accel_scale = 1e-3,
                                     .accel_misalignment_rad = 1e-3,
                                     .in_run_s = 900.0};

const InertialGrade kConsumerGrade{.gyro_bias_rad_s = 0.2 * kDegree,
                                   .gyro_in_run_rad_s = 30.0 * kDegreePerHour,
                                   .angle_walk_rad_sqrt_s = 0.4 * kDegree / 60.0,
                                   .gyro_scale = 1e-2,
                                   .gyro_misalignment_rad = 5e-3,
                                   .accel_bias_m_s2 = 30.0 * kMilliG,
                                   .accel_in_run_m_s2 = 1.0 * kMilliG,
                                   .velocity_walk_m_s_sqrt_s = 0.1 / 60.0,
                                   .accel_scale = 5e-3,
                                   .accel_misalignment_rad = 5e-3,
                                   .in_run_s = 600.0};

void tell(estimation::ImuConfig& imu, const InertialGrade& grade, double rate_hz) {
  imu.nominal_rate_hz = rate_hz;
  imu.angle_random_walk_rad_sqrt_s = grade.angle_walk_rad_sqrt_s;
  imu.velocity_random_walk_m_s_sqrt_s = grade.velocity_walk_m_s_sqrt_s;
  imu.gyro_bias_sigma_rad_s = grade.gyro_bias_rad_s;
  imu.gyro_bias_instability_rad_s = grade.gyro_in_run_rad_s;
  imu.gyro_bias_time_constant_s = grade.in_run_s;
  imu.accel_bias_sigma_m_s2 = grade.accel_bias_m_s2;
  imu.accel_bias_instability_m_s2 = grade.accel_in_run_m_s2;
  imu.accel_bias_time_constant_s = grade.in_run_s;
  imu.gyro_scale_sigma = grade.gyro_scale;
  imu.accel_scale_sigma = grade.accel_scale;
  imu.gyro_misalignment_sigma_rad = grade.gyro_misalignment_rad;
  imu.accel_misalignment_sigma_rad = grade.accel_misalignment_rad;
}

}  // namespace fathom::study
