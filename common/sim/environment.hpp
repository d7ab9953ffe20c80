#pragma once

#include <array>

namespace fathom::sim {

/// Water, air and ground around the vehicle.
struct EnvironmentConfig {
  double surface_altitude_m = 0.0;                ///< of the mean water surface above the ellipsoid
  double geoid_separation_m = 0.0;                ///< geoid above the ellipsoid, as receivers report it
  double water_depth_m = 60.0;                    ///< at the start
  double bottom_slope_N = 0.0;                    ///< metres deeper per metre north
  double magnetic_variation_rad = 0.0;            ///< east positive
  std::array<double, 2> current_N_m_s{0.0, 0.0};  ///< north, east
  double current_spread_m_s = 0.0;                ///< 1 sigma of each, about that, drawn once a run
  double current_from_s = 0.0;                    ///< sheltered water before: the current grows from zero ...
  double current_ramp_s = 5.0;                    ///< ... over this time
  std::array<double, 2> wind_N_m_s{0.0, 0.0};     ///< velocity of the air: north, east
  double air_temperature_offset_K = 0.0;          ///< warmer than the standard atmosphere
  double turbulence_m_s = 0.0;  ///< 1 sigma, lateral and vertical, of the flow around the vehicle
  double turbulence_tau_s = 1.0;
  double wave_height_m = 0.0;  ///< amplitude of the heave of the surface
  double wave_tilt_rad = 0.0;  ///< amplitude of the slope that a floating vehicle follows
  double wave_period_s = 4.0;
};

}  // namespace fathom::sim
