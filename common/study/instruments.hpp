#pragma once

#include <array>

#include "base/units.hpp"
#include "estimation/engine_config.hpp"
#include "sim/sensors/suite.hpp"

/// Instruments of the studies: one set of figures, from which the simulated errors are drawn and of which the
/// filters are told.
namespace fathom::study {

/// One standard deviation of one axis; SI units.
struct ImuGrade {
  double gyro_bias_rad_s;
  double gyro_in_run_rad_s;
  double angle_walk_rad_sqrt_s;
  double gyro_scale;
  double accel_bias_m_s2;
  double accel_in_run_m_s2;
  double velocity_walk_m_s_sqrt_s;
  double accel_scale;
  double misalignment_rad;  ///< of gyros and accelerometers
  double in_run_s;          ///< correlation time of the in-run biases
  /// Of each gyro to each axis of specific force; the bias is that at rest and level. Published filters do
  /// not know of it, nor does the simulator: only the consistency study draws it.
  double gyro_g_sensitivity_rad_s_per_m_s2 = 0.0;
};

/// HG1700 class.
inline constexpr ImuGrade kTactical{.gyro_bias_rad_s = 1.0 * kDegPerHour_rad_s,
                                    .gyro_in_run_rad_s = 0.3 * kDegPerHour_rad_s,
                                    .angle_walk_rad_sqrt_s = 0.125 * kRadPerDeg / 60.0,
                                    .gyro_scale = 150e-6,
                                    .accel_bias_m_s2 = 1.0 * kMilliG_m_s2,
                                    .accel_in_run_m_s2 = 0.05 * kMilliG_m_s2,
                                    .velocity_walk_m_s_sqrt_s = 0.065 * kFoot_m / 60.0,
                                    .accel_scale = 300e-6,
                                    .misalignment_rad = 0.3e-3,
                                    .in_run_s = 600.0};
/// Ring laser or fibre-optic unit that finds north by itself.
inline constexpr ImuGrade kNavigation{.gyro_bias_rad_s = 0.01 * kDegPerHour_rad_s,
                                      .gyro_in_run_rad_s = 0.003 * kDegPerHour_rad_s,
                                      .angle_walk_rad_sqrt_s = 0.002 * kRadPerDeg / 60.0,
                                      .gyro_scale = 10e-6,
                                      .accel_bias_m_s2 = 0.05 * kMilliG_m_s2,
                                      .accel_in_run_m_s2 = 0.01 * kMilliG_m_s2,
                                      .velocity_walk_m_s_sqrt_s = 1e-4,
                                      .accel_scale = 50e-6,
                                      .misalignment_rad = 0.02e-3,
                                      .in_run_s = 3600.0};

/// What the published filter knows of an IMU: biases and white noise. Scale and misalignment are neither
/// states nor noise to it.
enum class ImuModelling : std::uint8_t { biases, everything };

/// `real` 1 draws the errors, 0 makes a perfect unit of 100 Hz.
[[nodiscard]] sim::ImuConfig simulated(const ImuGrade& grade, double real);
void tell(estimation::ImuConfig& imu, const ImuGrade& grade, ImuModelling modelling);

/// Four-beam Doppler log, 30 degrees: white noise of a beam.
struct DvlNoise {
  double beam_m_s;
  double beam_per_speed;
};
inline constexpr double kBeam_rad = 30.0 * kRadPerDeg;
[[nodiscard]] sim::DvlConfig simulated(const DvlNoise& noise, double real);
/// The same noise as that of the velocity along the instrument's axes.
[[nodiscard]] estimation::SensorConfig told(const DvlNoise& noise, const std::array<double, 3>& lever_B_m);

/// As a filter that was published without gate and robust weights takes its measurements.
void believe_everything(estimation::SensorConfig& sensor);

}  // namespace fathom::study
