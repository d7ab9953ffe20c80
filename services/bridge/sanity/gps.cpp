#include "samples/gps.hpp"

#include "bridge/sanity/place.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const GpsSample& s, const Limits& limits) {
  constexpr double kLowest_m = -1'000.0;
  constexpr double kHighest_m = 100'000.0;
  Judge judge;
  judge.finite("velocity_N_m_s", s.velocity_N_m_s)
      .finite("position_sigma_N_m", s.position_sigma_N_m)
      .finite("velocity_sigma_N_m_s", s.velocity_sigma_N_m_s)
      .finite("altitude_m", s.altitude_m)
      .finite("altitude_msl_m", s.altitude_msl_m)
      .finite("hdop", s.hdop)
      .at_most("velocity_N_m_s", s.velocity_N_m_s, limits.gps_speed_m_s)
      .within("altitude_m", s.altitude_m, kLowest_m, kHighest_m)
      .within("altitude_msl_m", s.altitude_msl_m, kLowest_m, kHighest_m);
  return place(judge, "latitude_rad", s.latitude_rad, "longitude_rad", s.longitude_rad).verdict();
}

}  // namespace fathom::bridge
