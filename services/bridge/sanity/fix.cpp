#include "samples/position/fix.hpp"

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const FixSample& s, const Limits& limits) {
  if (!all_finite(std::array{s.latitude_rad, s.longitude_rad, s.sigma_m}) ||
      any_infinite(std::array{s.depth_m, s.depth_sigma_m}))
    return Refusal::not_finite;
  if (s.sigma_m <= 0.0 || s.depth_sigma_m <= 0.0 || beyond(s.depth_m, limits.depth_m))
    return Refusal::impossible;
  return position(s.latitude_rad, s.longitude_rad);
}

}  // namespace fathom::bridge
