#include "samples/airspeed.hpp"

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const AirspeedSample& s, const Limits& limits) {
  const std::array speeds{s.airspeed_m_s, s.true_airspeed_m_s};
  if (any_infinite(speeds) || (!known(speeds[0]) && !known(speeds[1])) || std::isinf(s.baro_altitude_m))
    return Refusal::not_finite;
  if (any_beyond(speeds, limits.airspeed_m_s) || s.sigma_m_s < 0.0) return Refusal::impossible;
  return std::nullopt;
}

}  // namespace fathom::bridge
