#include "samples/actuator.hpp"

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const PropulsionSample& s, const Limits& limits) {
  if (!std::isfinite(s.rpm)) return Refusal::not_finite;
  if (beyond(s.rpm, limits.rpm)) return Refusal::impossible;
  return std::nullopt;
}

template <>
Judgement judge(const FinsSample& s, const Limits& limits) {
  const std::array fins{s.rudder_rad, s.stern_rad};
  if (any_infinite(fins) || (!known(fins[0]) && !known(fins[1]))) return Refusal::not_finite;
  if (any_beyond(fins, limits.fin_rad)) return Refusal::impossible;
  return std::nullopt;
}

}  // namespace fathom::bridge
