#include "samples/gps.hpp"

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const GpsSample& s, const Limits& limits) {
  if (any_infinite(s.velocity_N_m_s) || any_infinite(s.position_sigma_N_m) ||
      any_infinite(s.velocity_sigma_N_m_s) ||
      any_infinite(std::array{s.altitude_m, s.altitude_msl_m, s.hdop})) {
    return Refusal::not_finite;
  }
  if (any_beyond(s.velocity_N_m_s, limits.gps_speed_m_s)) return Refusal::impossible;
  constexpr double kLowest_m = -1'000.0;
  constexpr double kHighest_m = 100'000.0;
  for (const double altitude_m : {s.altitude_m, s.altitude_msl_m}) {
    if (altitude_m < kLowest_m || altitude_m > kHighest_m) return Refusal::impossible;
  }
  return position(s.latitude_rad, s.longitude_rad);
}

}  // namespace fathom::bridge
