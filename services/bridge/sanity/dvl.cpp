#include "samples/dvl.hpp"

#include "bridge/sanity/judge.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const DvlSample& s, const Limits& limits) {
  return Judge()
      .finite("velocity_D_m_s", s.velocity_D_m_s)
      .finite("beam_velocity_m_s", s.beam_velocity_m_s)
      .finite("beam_range_m", s.beam_range_m)
      .finite("error_velocity_m_s", s.error_velocity_m_s)
      .finite("sigma_m_s", s.sigma_m_s)
      .finite("altitude_m", s.altitude_m)
      .finite("sound_speed_m_s", s.sound_speed_m_s)
      .at_most("velocity_D_m_s", s.velocity_D_m_s, limits.dvl_speed_m_s)
      .at_most("beam_velocity_m_s", s.beam_velocity_m_s, limits.dvl_speed_m_s)
      .not_negative("altitude_m", s.altitude_m)
      .not_negative("sigma_m_s", s.sigma_m_s)
      .verdict();
}

}  // namespace fathom::bridge
