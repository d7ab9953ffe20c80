#include "samples/range.hpp"

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const RangeSample& s, const Limits& limits) {
  if (!all_finite(std::array{s.range_m}) ||
      any_infinite(std::array{s.sigma_m, s.travel_time_s, s.beacon_depth_m}))
    return Refusal::not_finite;
  if (s.range_m <= 0.0 || beyond(s.range_m, limits.acoustic_range_m) || s.sigma_m < 0.0)
    return Refusal::impossible;
  return position(s.beacon_latitude_rad, s.beacon_longitude_rad);
}

}  // namespace fathom::bridge
