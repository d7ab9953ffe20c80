#include "samples/depth.hpp"

#include "bridge/sanity/judge.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const DepthSample& s, const Limits& limits) {
  constexpr double kHighest_m = 100.0;  // a vehicle may be in the air before it is in the water
  return Judge()
      .numbers("depth_m", s.depth_m)
      .within("depth_m", s.depth_m, -kHighest_m, limits.depth_m)
      .verdict();
}

}  // namespace fathom::bridge
