#include "samples/depth.hpp"

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const DepthSample& s, const Limits& limits) {
  constexpr double kHighest_m = 100.0;  // a vehicle may be in the air before it is in the water
  if (!std::isfinite(s.depth_m)) return Refusal::not_finite;
  if (s.depth_m > limits.depth_m || s.depth_m < -kHighest_m) return Refusal::impossible;
  return std::nullopt;
}

}  // namespace fathom::bridge
