#include "samples/dvl.hpp"

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const DvlSample& s, const Limits& limits) {
  if (any_infinite(s.velocity_D_m_s) || any_infinite(s.beam_velocity_m_s) || any_infinite(s.beam_range_m) ||
      any_infinite(std::array{s.error_velocity_m_s, s.sigma_m_s, s.altitude_m, s.sound_speed_m_s})) {
    return Refusal::not_finite;
  }
  if (any_beyond(s.velocity_D_m_s, limits.dvl_speed_m_s) ||
      any_beyond(s.beam_velocity_m_s, limits.dvl_speed_m_s)) {
    return Refusal::impossible;
  }
  if (s.altitude_m < 0.0 || s.sigma_m_s < 0.0) return Refusal::impossible;
  return std::nullopt;
}

}  // namespace fathom::bridge
