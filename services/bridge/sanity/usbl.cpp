#include "samples/usbl.hpp"

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const UsblSample& s, const Limits& limits) {
  const bool geodetic = s.frame == UsblFrame::geodetic;
  const bool polar = !geodetic && (known(s.range_m) || known(s.bearing_rad));
  const std::array where{geodetic ? s.latitude_rad : s.relative_m[0],
                         geodetic ? s.longitude_rad : s.relative_m[1]};
  if ((!polar && !all_finite(where)) ||
      any_infinite(std::array{s.depth_m, s.sigma_m, s.travel_time_s, s.relative_m[2], s.range_m,
                              s.bearing_rad, s.depression_rad, s.sigma_rad, s.station_depth_m}) ||
      any_infinite(s.station_rpy_rad)) {
    return Refusal::not_finite;
  }
  if (any_beyond(s.relative_m, limits.acoustic_range_m) || beyond(s.depth_m, limits.depth_m) ||
      s.sigma_m < 0.0 || s.range_m <= 0.0 || beyond(s.range_m, limits.acoustic_range_m) ||
      beyond(s.depression_rad, 0.5 * std::numbers::pi) || beyond(s.bearing_rad, 2.0 * std::numbers::pi)) {
    return Refusal::impossible;
  }
  if (const Judgement verdict = position(s.station_latitude_rad, s.station_longitude_rad)) return verdict;
  return position(s.latitude_rad, s.longitude_rad);
}

}  // namespace fathom::bridge
