#pragma once

#include <array>

#include "base/units.hpp"
#include "study/instruments.hpp"

/// Instruments of the consistency study, by grade: from one set of figures the errors are drawn and the
/// filters are told. SI units, one standard deviation of one axis.
namespace fathom::study {

// Inertial units beside kNavigation (study/instruments.hpp).
/// A tactical unit with the in-run drift of its data sheet.
inline constexpr ImuGrade kTacticalGrade{.gyro_bias_rad_s = 1.0 * kDegPerHour_rad_s,
                                         .gyro_in_run_rad_s = 0.3 * kDegPerHour_rad_s,
                                         .angle_walk_rad_sqrt_s = 0.1 * kRadPerDeg / 60.0,
                                         .gyro_scale = 150e-6,
                                         .accel_bias_m_s2 = 1.0 * kMilliG_m_s2,
                                         .accel_in_run_m_s2 = 0.1 * kMilliG_m_s2,
                                         .velocity_walk_m_s_sqrt_s = 0.02 / 60.0,
                                         .accel_scale = 300e-6,
                                         .misalignment_rad = 0.3e-3,
                                         .in_run_s = 1800.0};
/// A good MEMS unit, calibrated over temperature (ADIS16490 class).
inline constexpr ImuGrade kIndustrialGrade{
    .gyro_bias_rad_s = 20.0 * kDegPerHour_rad_s,
    .gyro_in_run_rad_s = 3.0 * kDegPerHour_rad_s,
    .angle_walk_rad_sqrt_s = 0.15 * kRadPerDeg / 60.0,
    .gyro_scale = 1e-3,
    .accel_bias_m_s2 = 4.0 * kMilliG_m_s2,
    .accel_in_run_m_s2 = 0.3 * kMilliG_m_s2,
    .velocity_walk_m_s_sqrt_s = 0.03 / 60.0,
    .accel_scale = 1e-3,
    .misalignment_rad = 1e-3,
    .in_run_s = 900.0,
    .gyro_g_sensitivity_rad_s_per_m_s2 = 0.005 * kRadPerDeg / kStandardGravity_m_s2};
/// A MEMS chip as it comes (consumer parts on autopilots).
inline constexpr ImuGrade kConsumerGrade{
    .gyro_bias_rad_s = 0.2 * kRadPerDeg,
    .gyro_in_run_rad_s = 30.0 * kDegPerHour_rad_s,
    .angle_walk_rad_sqrt_s = 0.4 * kRadPerDeg / 60.0,
    .gyro_scale = 1e-2,
    .accel_bias_m_s2 = 30.0 * kMilliG_m_s2,
    .accel_in_run_m_s2 = 1.0 * kMilliG_m_s2,
    .velocity_walk_m_s_sqrt_s = 0.1 / 60.0,
    .accel_scale = 5e-3,
    .misalignment_rad = 5e-3,
    .in_run_s = 600.0,
    .gyro_g_sensitivity_rad_s_per_m_s2 = 0.1 * kRadPerDeg / kStandardGravity_m_s2};

struct GpsFigures {
  double rate_hz = 5.0;
  double noise_m = 0.5;  ///< white; twice of it down
  double drift_m = 1.0;  ///< slow; twice of it down
  double drift_s = 300.0;
  double velocity_m_s = 0.05;  ///< twice of it down
  std::array<double, 3> lever_B_m{0.3, 0.0, -0.5};
};

/// On an aircraft or a car.
inline constexpr GpsFigures kAirborneGps{.rate_hz = 5.0,
                                         .noise_m = 0.5,
                                         .drift_m = 1.5,
                                         .drift_s = 200.0,
                                         .velocity_m_s = 0.1,
                                         .lever_B_m = {0.5, 0.0, -0.3}};

struct DvlFigures {
  double rate_hz = 5.0;
  double noise_m_s = 0.006;
  double per_speed = 0.002;  ///< white noise that grows with the speed
  double scale = 0.01;
  double bias_m_s = 0.002;
  double misalignment_rad = 0.0175;
  std::array<double, 3> lever_B_m{0.5, 0.0, 0.2};
};

struct DepthFigures {
  double rate_hz = 5.0;
  double noise_m = 0.02;
  double bias_m = 0.05;
};

struct CompassFigures {
  double rate_hz = 2.0;
  double noise_rad = 0.009;
  double bias_rad = 0.0175;
};

}  // namespace fathom::study
