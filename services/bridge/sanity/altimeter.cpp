#include "samples/altimeter.hpp"

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const AltimeterSample& s, const Limits& limits) {
  // Unknown: it hears no bottom.
  if (any_infinite(std::array{s.altitude_m, s.transducer_offset_m})) return Refusal::not_finite;
  if (s.altitude_m < 0.0 || beyond(s.altitude_m, limits.depth_m)) return Refusal::impossible;
  return std::nullopt;
}

}  // namespace fathom::bridge
