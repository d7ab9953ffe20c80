#include "samples/heading.hpp"

#include <cmath>
#include <numbers>

#include "bridge/sanity/judge.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const HeadingSample& s, const Limits&) {
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  return Judge()
      .numbers("heading_rad", s.heading_rad)
      .within("heading_rad", s.heading_rad, 0.0, std::nextafter(kTurn_rad, 0.0))
      .verdict();
}

}  // namespace fathom::bridge
