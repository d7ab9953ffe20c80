#pragma once

#include <cstdint>

#include "base/unknown.hpp"

namespace fathom::estimation {

/// What "straight and steady" means (ALN-11): each magnitude below its limit for its hold time.
struct StabilityConfig {
  double roll_rad = 0.26179938779914941;  ///< 15 degrees, navigated
  double roll_hold_s = 3.0;
  double pitch_rad = 0.087266462599716474;  ///< 5 degrees, navigated
  double pitch_hold_s = 1.0;
  double depth_error_m = 10.0;  ///< from the set depth
  double depth_hold_s = 1.0;
  double rate_y_rad_s = 0.052359877559829883;  ///< 3 degrees/s
  double rate_y_hold_s = 1.0;
  double force_x_m_s2 = 1.0;
  double force_x_hold_s = 1.0;
  // Beyond the published ones, against false alignment in a turn or with a large roll error.
  double rate_z_rad_s = 0.034906585039886591;  ///< 2 degrees/s
  double rate_z_hold_s = 1.0;
  double gravity_defect_m_s2 = 0.35;  ///< of | |f| - g |
  double gravity_hold_s = 1.0;
  double speed_slope_m_s2 = 0.25;  ///< of the speed log's rate of change
  double speed_slope_hold_s = 1.0;
  double force_spread_m_s2 = 0.09;  ///< standard deviation of f_x within the window, vibration aside
  double flow_spread_m_s2 = 0.075;  ///< likewise of f_y, by the window and the seconds before it
  double spread_low_pass_s = 0.1;   ///< time constant before the spread
  double low_pass_s = 0.3;          ///< time constant before the gates; 0: none
  double window_s = 1.0;            ///< of averaging
  double max_gap_s = 0.02;          ///< between inertial samples
};

/// Alignment of a vehicle that was dropped with its roll and pitch unknown and runs under water.
struct DropConfig {
  enum class Form : std::uint8_t { robust = 0, printed = 1 };
  StabilityConfig stability;
  Form form = Form::robust;
  bool fine = true;                             ///< refine the coarse solution with the tilt filter
  bool early = true;                            ///< run the tilt filter before a coarse solution exists
  double fine_delay_s = 2.5;                    ///< of the early filter after water entry
  double alone_s = 15.0;                        ///< the early filter may align without a coarse window after
  double set_depth_m = 80.0;                    ///< of the straight run
  double wet_depth_m = 1.0;                     ///< deeper is in the water
  double timeout_s = 25.0;                      ///< after water entry
  double tilt_sigma_rad = 0.26179938779914941;  ///< of the roll and pitch handed over: 15 degrees
  double heading_sigma_rad = 0.017453292519943295;        ///< of the heading handed over
  double aligned_tilt_sigma_rad = 4.3633231299858239e-3;  ///< 0.25 degrees
  double aligned_hold_s = 1.0;
  // Instruments.
  double accel_sigma_m_s2 = 0.011;  ///< what is left of bias, scale and misalignment
  double accel_noise_m_s_sqrt_s = 1e-3;
  double gyro_noise_rad_sqrt_s = 2e-5;
  double gyro_misalignment_rad = 5e-4;  ///< of scale and axes: attitude error per angle turned
  double speed_per_rpm = 0.0068;
  double speed_sigma_m_s = 0.1;  ///< white
  double speed_scale_sigma = 0.015;
  double speed_bias_sigma_m_s = 0.02;
  double speed_bias_tau_s = 5.0;
  double depth_sigma_m = 0.05;
  double sensor_timeout_s = 0.35;  ///< older propulsor speed or depth is missing
  // The vehicle: how it slips through the water (TILT-5). There is no default, each hull has its own; an
  // engine that starts by air drop refuses a configuration without them.
  double slip_per_turn_m = kUnknown;  ///< side velocity per turn rate
  double trim_m2_s2 = kUnknown;       ///< heave velocity times speed that carries the weight in water
  double flow_lag_m = kUnknown;       ///< distance travelled in one time constant of the slip
  double surge_tau_s = kUnknown;      ///< in which the speed follows the thrust
  double speed_lag_s = kUnknown;      ///< by which the propulsor follows the speed
  // What the slip model does not know.
  double flow_sigma_m_s = 0.08;  ///< of what the model does not know, turbulence included
  double flow_tau_s = 10.0;
};

}  // namespace fathom::estimation
