#pragma once

// Description of how the attitude is found.

#include "base/field.hpp"
#include "base/units.hpp"
#include "estimation/engine_config.hpp"

namespace fathom::estimation {

template <template <class> class Walk>
void describe(Walk<AlignmentConfig>& s) {
  using C = AlignmentConfig;
  s.field("heading_source", &C::heading_source, "where the first heading comes from")
      .words({{"automatic", HeadingSource::automatic},
              {"compass", HeadingSource::compass},
              {"given", HeadingSource::given},
              {"gyrocompass", HeadingSource::gyrocompass},
              {"two_antenna", HeadingSource::two_antenna}});
  s.field("given_heading_deg", &C::given_heading_rad,
          "heading of the first start where heading_source is \"given\"")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("given_heading_sigma_deg", &C::given_heading_sigma_rad, "uncertainty of the given heading")
      .unit("deg")
      .range(1e-3, 180)
      .scaled(kRadPerDeg);
  s.field("averaging_s", &C::averaging_s, "window of levelling").unit("s").range(0.5, 3600);
  s.field("rate_spread_deg_s", &C::rate_spread_rad_s,
          "the vehicle is at rest while the standard deviation of each rate in the window is below this")
      .unit("deg/s")
      .range(1e-4, 570)
      .scaled(kRadPerDeg);
  s.field("force_spread_m_s2", &C::force_spread_m_s2,
          "the vehicle is at rest while the standard deviation of each specific force is below this")
      .unit("m/s^2")
      .range(1e-5, 100);
  s.field("max_speed_m_s", &C::max_speed_m_s, "the vehicle is at rest while the GPS speed is below this")
      .unit("m/s")
      .range(1e-3, 100);
  s.field("rest_velocity_sigma_m_s", &C::rest_velocity_sigma_m_s,
          "uncertainty of the velocity zero that levelling ends with")
      .unit("m/s")
      .range(1e-4, 10);
  s.field("tilt_sigma_floor_deg", &C::tilt_sigma_floor_rad,
          "levelling is not believed to be better than this")
      .unit("deg")
      .range(1e-4, 57)
      .scaled(kRadPerDeg);
  s.field("compass_sigma_deg", &C::compass_sigma_rad,
          "uncertainty of a heading taken from a compass, deviation included")
      .unit("deg")
      .range(1e-3, 180)
      .scaled(kRadPerDeg);
  s.field("gyrocompass_limit_deg", &C::gyrocompass_limit_rad, "coarsest gyrocompass heading that is accepted")
      .unit("deg")
      .range(1e-3, 180)
      .scaled(kRadPerDeg);
  s.field(
       "in_motion_speed_m_s", &C::in_motion_speed_m_s,
       "above this speed the course over ground is a heading within in_motion_heading_sigma_deg; 0: at any "
       "speed at which that, the current's sigma and the noise of GPS over the speed leave 17 degrees")
      .unit("m/s")
      .range(0, 1000);
  s.field("in_motion_heading_sigma_deg", &C::in_motion_heading_sigma_rad,
          "uncertainty of a heading taken from the course: how far the vehicle may crab; above 17 degrees "
          "without "
          "in_motion_speed_m_s the course is no heading, and how the velocity of GPS changes tells it")
      .unit("deg")
      .range(0.01, 180)
      .scaled(kRadPerDeg);
  s.field("in_motion_tilt_sigma_deg", &C::in_motion_tilt_sigma_rad,
          "uncertainty of roll and pitch that are levelled under way without GPS")
      .unit("deg")
      .range(0.01, 57)
      .scaled(kRadPerDeg);
  s.field("in_motion_averaging_s", &C::in_motion_averaging_s,
          "window of levelling in motion; between two velocities of GPS where there are any")
      .unit("s")
      .range(0.1, 600);
  s.field("aligned_tilt_sigma_deg", &C::aligned_tilt_sigma_rad,
          "aligned once roll and pitch are known to this, or to twice what scale and misalignment of the "
          "accelerometers make of gravity")
      .unit("deg")
      .range(1e-4, 57)
      .scaled(kRadPerDeg);
  s.field("aligned_heading_sigma_deg", &C::aligned_heading_sigma_rad,
          "aligned once the heading is known to this")
      .unit("deg")
      .range(1e-4, 180)
      .scaled(kRadPerDeg);
  s.field("aligned_hold_s", &C::aligned_hold_s, "aligned once both have been known for this long")
      .unit("s")
      .range(0, 600);
  s.field("timeout_s", &C::timeout_s, "waiting and averaging for longer is reported as timed out")
      .unit("s")
      .range(1, 1e6);
  s.field("position_given", &C::position_given,
          "begin at the given position when no GPS fix is at hand; a later start is where the vehicle was "
          "seen last");
  s.field("given_latitude_deg", &C::given_latitude_rad, "latitude for position_given")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg);
  s.field("given_longitude_deg", &C::given_longitude_rad, "longitude for position_given")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("given_altitude_m", &C::given_altitude_m,
          "height for position_given, above the WGS-84 ellipsoid, up")
      .unit("m")
      .range(-12'000, 50'000);
  s.field("position_sigma_m", &C::position_sigma_m, "floor of a start position taken from GPS")
      .unit("m")
      .range(1e-3, 1e4);
}

}  // namespace fathom::estimation
