#include "samples/altimeter.hpp"

#include "bridge/sanity/judge.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const AltimeterSample& s, const Limits& limits) {
  // Unknown: it hears no bottom.
  return Judge()
      .finite("altitude_m", s.altitude_m)
      .finite("transducer_offset_m", s.transducer_offset_m)
      .within("altitude_m", s.altitude_m, 0.0, limits.depth_m)
      .verdict();
}

}  // namespace fathom::bridge
