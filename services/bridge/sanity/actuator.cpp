#include "samples/actuator.hpp"

#include "base/unknown.hpp"
#include "bridge/sanity/judge.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const PropulsionSample& s, const Limits& limits) {
  return Judge().numbers("rpm", s.rpm).at_most("rpm", s.rpm, limits.rpm).verdict();
}

template <>
Judgement judge(const FinsSample& s, const Limits& limits) {
  Judge judge;
  if (!known(s.rudder_rad) && !known(s.stern_rad)) judge.numbers("rudder_rad", s.rudder_rad);
  return judge.finite("rudder_rad", s.rudder_rad)
      .finite("stern_rad", s.stern_rad)
      .at_most("rudder_rad", s.rudder_rad, limits.fin_rad)
      .at_most("stern_rad", s.stern_rad, limits.fin_rad)
      .verdict();
}

}  // namespace fathom::bridge
