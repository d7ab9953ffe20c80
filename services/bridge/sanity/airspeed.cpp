#include "samples/airspeed.hpp"

#include "base/unknown.hpp"
#include "bridge/sanity/judge.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const AirspeedSample& s, const Limits& limits) {
  Judge judge;
  if (!known(s.airspeed_m_s) && !known(s.true_airspeed_m_s)) judge.numbers("airspeed_m_s", s.airspeed_m_s);
  return judge.finite("airspeed_m_s", s.airspeed_m_s)
      .finite("true_airspeed_m_s", s.true_airspeed_m_s)
      .finite("baro_altitude_m", s.baro_altitude_m)
      .finite("sigma_m_s", s.sigma_m_s)
      .at_most("airspeed_m_s", s.airspeed_m_s, limits.airspeed_m_s)
      .at_most("true_airspeed_m_s", s.true_airspeed_m_s, limits.airspeed_m_s)
      .not_negative("sigma_m_s", s.sigma_m_s)
      .verdict();
}

}  // namespace fathom::bridge
