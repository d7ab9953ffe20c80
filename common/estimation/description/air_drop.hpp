#pragma once

// Description of the alignment after a drop.

#include "base/field.hpp"
#include "base/units.hpp"
#include "estimation/alignment/drop_config.hpp"

namespace fathom::estimation {

template <template <class> class Walk>
void describe(Walk<StabilityConfig>& s) {
  using C = StabilityConfig;
  const auto limit = [&s](const char* key, double C::*member, const char* unit, double scale,
                          const char* hold_key, double C::*hold, const char* of) {
    s.field(key, member, std::string("largest ") + of).unit(unit).range(1e-6, 1e4).scaled(scale);
    s.field(hold_key, hold, std::string("time for which it has to stay: ") + of).unit("s").range(0, 600);
  };
  limit("roll_deg", &C::roll_rad, "deg", kRadPerDeg, "roll_hold_s", &C::roll_hold_s, "navigated roll");
  limit("pitch_deg", &C::pitch_rad, "deg", kRadPerDeg, "pitch_hold_s", &C::pitch_hold_s, "navigated pitch");
  limit("depth_error_m", &C::depth_error_m, "m", 1.0, "depth_hold_s", &C::depth_hold_s,
        "distance from the set depth");
  limit("rate_y_deg_s", &C::rate_y_rad_s, "deg/s", kRadPerDeg, "rate_y_hold_s", &C::rate_y_hold_s,
        "pitch rate");
  limit("force_x_m_s2", &C::force_x_m_s2, "m/s^2", 1.0, "force_x_hold_s", &C::force_x_hold_s,
        "specific force along x");
  limit("rate_z_deg_s", &C::rate_z_rad_s, "deg/s", kRadPerDeg, "rate_z_hold_s", &C::rate_z_hold_s,
        "turn rate");
  limit("gravity_defect_m_s2", &C::gravity_defect_m_s2, "m/s^2", 1.0, "gravity_hold_s", &C::gravity_hold_s,
        "difference of specific force and gravity");
  limit("speed_slope_m_s2", &C::speed_slope_m_s2, "m/s^2", 1.0, "speed_slope_hold_s", &C::speed_slope_hold_s,
        "change of the speed log");
  s.field("force_spread_m_s2", &C::force_spread_m_s2,
          "largest standard deviation of the force along x within the window, vibration aside")
      .unit("m/s^2")
      .range(1e-4, 100);
  s.field("flow_spread_m_s2", &C::flow_spread_m_s2,
          "largest standard deviation of the force along y, by the window and the seconds before it")
      .unit("m/s^2")
      .range(1e-4, 100);
  s.field("spread_low_pass_s", &C::spread_low_pass_s,
          "time constant of the low pass before the standard deviation")
      .unit("s")
      .range(0, 10);
  s.field("low_pass_s", &C::low_pass_s, "time constant of the low pass before the limits; 0: none")
      .unit("s")
      .range(0, 10);
  s.field("window_s", &C::window_s, "window of averaging").unit("s").range(0.1, 60);
  s.field("max_gap_s", &C::max_gap_s,
          "longest gap between inertial samples; a longer one begins everything anew")
      .unit("s")
      .range(1e-3, 1);
}

template <template <class> class Walk>
void describe(Walk<DropConfig>& s) {
  using C = DropConfig;
  s.field("stability", &C::stability, "what counts as a straight and steady run");
  s.field("form", &C::form, "form of the coarse solution")
      .words({{"robust", C::Form::robust}, {"printed", C::Form::printed}});
  s.field("fine", &C::fine, "refine the coarse solution; without it roll and pitch are never aligned");
  s.field("early", &C::early, "begin the fine solution before there is a coarse one");
  s.field("fine_delay_s", &C::fine_delay_s, "time from water entry to an early fine solution")
      .unit("s")
      .range(0, 600);
  s.field("alone_s", &C::alone_s, "after this time the fine solution needs no coarse one")
      .unit("s")
      .range(1, 3600);
  s.field("set_depth_m", &C::set_depth_m, "depth of the straight run, below the surface")
      .unit("m")
      .range(0, 12'000);
  s.field("wet_depth_m", &C::wet_depth_m, "a greater depth is in the water").unit("m").range(0, 100);
  s.field("timeout_s", &C::timeout_s, "time after water entry at which alignment is reported as timed out")
      .unit("s")
      .range(1, 1e5);
  s.field("tilt_sigma_deg", &C::tilt_sigma_rad,
          "uncertainty of roll and pitch when an order has them found again")
      .unit("deg")
      .range(0.1, 45)
      .scaled(kRadPerDeg);
  s.field("aligned_tilt_sigma_deg", &C::aligned_tilt_sigma_rad,
          "aligned once roll and pitch are known to this")
      .unit("deg")
      .range(1e-3, 45)
      .scaled(kRadPerDeg);
  s.field("aligned_hold_s", &C::aligned_hold_s, "aligned once they have been known for this long")
      .unit("s")
      .range(0, 600);
  s.field("accel_sigma_m_s2", &C::accel_sigma_m_s2,
          "error of the accelerometer: bias, scale and axes together")
      .unit("m/s^2")
      .range(1e-6, 10);
  s.field("accel_noise_m_s_sqrt_s", &C::accel_noise_m_s_sqrt_s,
          "least white noise of the accelerometer; vibration is measured")
      .unit("m/s/sqrt(s)")
      .range(1e-7, 10);
  s.field("gyro_noise_rad_sqrt_s", &C::gyro_noise_rad_sqrt_s, "white noise of the gyro")
      .unit("rad/sqrt(s)")
      .range(1e-9, 1);
  s.field("gyro_misalignment_rad", &C::gyro_misalignment_rad,
          "gyro scale and axes: attitude error per angle turned")
      .unit("rad")
      .range(0, 0.1);
  s.field("speed_sigma_m_s", &C::speed_sigma_m_s, "white noise of a sample of the speed by propulsor")
      .unit("m/s")
      .range(1e-4, 10);
  s.field("speed_scale_sigma", &C::speed_scale_sigma,
          "error of the factor from shaft speed to speed, a ratio")
      .range(1e-6, 1);
  s.field("speed_bias_sigma_m_s", &C::speed_bias_sigma_m_s, "slow error of the speed by propulsor")
      .unit("m/s")
      .range(1e-6, 10);
  s.field("speed_bias_tau_s", &C::speed_bias_tau_s, "time constant of that slow error")
      .unit("s")
      .range(0.1, 1e5);
  s.field("speed_lag_s", &C::speed_lag_s, "time by which the propulsor follows the speed")
      .unit("s")
      .range(0, 10)
      .nullable();
  s.field("depth_sigma_m", &C::depth_sigma_m, "white noise of a depth sample").unit("m").range(1e-4, 100);
  s.field("sensor_timeout_s", &C::sensor_timeout_s, "an older depth or propulsor speed is missing")
      .unit("s")
      .range(0.01, 10);
  s.field("slip_per_turn_m", &C::slip_per_turn_m, "side velocity of the hull per turn rate")
      .unit("m")
      .range(0, 100)
      .nullable();
  s.field("trim_m2_s2", &C::trim_m2_s2, "heave velocity times speed that carries the weight in water")
      .unit("m^2/s^2")
      .range(-1000, 1000)
      .nullable();
  s.field("flow_lag_m", &C::flow_lag_m, "distance travelled in one time constant of the slip")
      .unit("m")
      .range(0.01, 1000)
      .nullable();
  s.field("flow_sigma_m_s", &C::flow_sigma_m_s, "flow that the slip model does not know, turbulence included")
      .unit("m/s")
      .range(1e-4, 10);
  s.field("flow_tau_s", &C::flow_tau_s, "correlation time of that flow").unit("s").range(0.1, 1e5);
  s.field("surge_tau_s", &C::surge_tau_s, "time constant in which the speed follows the thrust")
      .unit("s")
      .range(0.05, 600)
      .nullable();
}

}  // namespace fathom::estimation
