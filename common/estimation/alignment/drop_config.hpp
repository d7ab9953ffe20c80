#pragma once

// Configuration of the alignment after a drop: members and defaults. What they mean stands in
// estimation/description/air_drop.hpp.

#include <cstdint>

#include "base/unknown.hpp"

namespace fathom::estimation {

/// What "straight and steady" means (ALN-11): each magnitude below its limit for its hold time.
struct StabilityConfig {
  double roll_rad = 0.26179938779914941;  ///< 15 degrees
  double roll_hold_s = 3.0;
  double pitch_rad = 0.087266462599716474;  ///< 5 degrees
  double pitch_hold_s = 1.0;
  double depth_error_m = 10.0;
  double depth_hold_s = 1.0;
  double rate_y_rad_s = 0.052359877559829883;  ///< 3 degrees/s
  double rate_y_hold_s = 1.0;
  double force_x_m_s2 = 1.0;
  double force_x_hold_s = 1.0;
  // Beyond the published ones, against false alignment in a turn or with a large roll error.
  double rate_z_rad_s = 0.034906585039886591;  ///< 2 degrees/s
  double rate_z_hold_s = 1.0;
  double gravity_defect_m_s2 = 0.35;
  double gravity_hold_s = 1.0;
  double speed_slope_m_s2 = 0.25;
  double speed_slope_hold_s = 1.0;
  double force_spread_m_s2 = 0.09;
  double flow_spread_m_s2 = 0.075;
  double spread_low_pass_s = 0.1;
  double low_pass_s = 0.3;
  double window_s = 1.0;
  double max_gap_s = 0.02;
};

/// Alignment of a vehicle that was dropped with its roll and pitch unknown and runs under water.
struct DropConfig {
  enum class Form : std::uint8_t { robust = 0, printed = 1 };
  StabilityConfig stability;
  Form form = Form::robust;
  bool fine = true;
  bool early = true;
  double fine_delay_s = 2.5;
  double alone_s = 15.0;
  double set_depth_m = 80.0;
  double wet_depth_m = 1.0;
  double timeout_s = 25.0;
  double tilt_sigma_rad = 0.26179938779914941;            ///< 15 degrees
  double heading_sigma_rad = 0.017453292519943295;        ///< of the heading handed over; has no key
  double aligned_tilt_sigma_rad = 4.3633231299858239e-3;  ///< 0.25 degrees
  double aligned_hold_s = 1.0;
  // Instruments.
  double accel_sigma_m_s2 = 0.011;
  double accel_noise_m_s_sqrt_s = 1e-3;
  double gyro_noise_rad_sqrt_s = 2e-5;
  double gyro_misalignment_rad = 5e-4;
  double speed_per_rpm = 0.0068;  ///< from the propulsion sensor, has no key
  double speed_sigma_m_s = 0.1;
  double speed_scale_sigma = 0.015;
  double speed_bias_sigma_m_s = 0.02;
  double speed_bias_tau_s = 5.0;
  double depth_sigma_m = 0.05;
  double sensor_timeout_s = 0.35;
  // The vehicle: how it slips through the water (TILT-5). There is no default, each hull has its own; an
  // engine that starts by air drop refuses a configuration without them.
  double slip_per_turn_m = kUnknown;
  double trim_m2_s2 = kUnknown;
  double flow_lag_m = kUnknown;
  double surge_tau_s = kUnknown;
  double speed_lag_s = kUnknown;
  // What the slip model does not know.
  double flow_sigma_m_s = 0.08;
  double flow_tau_s = 10.0;
};

}  // namespace fathom::estimation
