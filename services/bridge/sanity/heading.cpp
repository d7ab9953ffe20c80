#include "samples/heading.hpp"

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const HeadingSample& s, const Limits&) {
  if (!std::isfinite(s.heading_rad)) return Refusal::not_finite;
  if (s.heading_rad < 0.0 || s.heading_rad >= 2.0 * std::numbers::pi) return Refusal::impossible;
  return std::nullopt;
}

}  // namespace fathom::bridge
