#include "samples/imu.hpp"

#include "bridge/sanity/judge.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const ImuSample& s, const Limits& limits) {
  constexpr double kLongest_s = 1.0;
  return Judge()
      .numbers("angular_rate_B_rad_s", s.angular_rate_B_rad_s)
      .numbers("specific_force_B_m_s2", s.specific_force_B_m_s2)
      .finite("delta_angle_B_rad", s.delta_angle_B_rad)
      .finite("delta_velocity_B_m_s", s.delta_velocity_B_m_s)
      .finite("delta_time_s", s.delta_time_s)
      .at_most("angular_rate_B_rad_s", s.angular_rate_B_rad_s, limits.angular_rate_rad_s)
      .at_most("specific_force_B_m_s2", s.specific_force_B_m_s2, limits.specific_force_m_s2)
      .positive("delta_time_s", s.delta_time_s)
      .at_most("delta_time_s", s.delta_time_s, kLongest_s)
      .verdict();
}

}  // namespace fathom::bridge
