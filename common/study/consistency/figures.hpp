#pragma once

#include <array>

#include "estimation/engine_config.hpp"

/// Instruments of the consistency study, by grade: from one set of figures the errors are drawn and the
/// filters are told. SI units, one standard deviation of one axis.
namespace fathom::study {

struct InertialGrade {
  double gyro_bias_rad_s;
  double gyro_in_run_rad_s;
  double angle_walk_rad_sqrt_s;
  double gyro_scale;
  double gyro_misalignment_rad;
  double accel_bias_m_s2;
  double accel_in_run_m_s2;
  double velocity_walk_m_s_sqrt_s;
  double accel_scale;
  double accel_misalignment_rad;
  double in_run_s;  ///< correlation time of what changes in the run
};

/// Ring laser or fibre-optic unit that finds north by itself.
extern const InertialGrade kNavigationGrade;
/// HG1700 class.
extern const InertialGrade kTacticalGrade;
/// A good MEMS unit, calibrated over temperature (ADIS16490 class).
extern const InertialGrade kIndustrialGrade;
/// A MEMS chip as it comes (consumer parts on autopilots).
extern const InertialGrade kConsumerGrade;

struct GpsFigures {
  double rate_hz = 5.0;
  double noise_m = 0.5;  ///< white; twice of it down
  double drift_m = 1.0;  ///< slow; twice of it down
  double drift_s = 300.0;
  double velocity_m_s = 0.05;  ///< twice of it down
  std::array<double, 3> lever_B_m{0.3, 0.0, -0.5};
};

struct DvlFigures {
  double rate_hz = 5.0;
  double noise_m_s = 0.006;
  double per_speed = 0.002;  ///< white noise that grows with the speed
  double scale = 0.01;
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

/// Tells the filter, as a user would from the data sheet.
void tell(estimation::ImuConfig& imu, const InertialGrade& grade, double rate_hz);

}  // namespace fathom::study
