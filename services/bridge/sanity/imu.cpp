#include "samples/imu.hpp"

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const ImuSample& s, const Limits& limits) {
  if (!all_finite(s.angular_rate_B_rad_s) || !all_finite(s.specific_force_B_m_s2)) return Refusal::not_finite;
  if (any_infinite(s.delta_angle_B_rad) || any_infinite(s.delta_velocity_B_m_s) ||
      std::isinf(s.delta_time_s)) {
    return Refusal::not_finite;
  }
  if (any_beyond(s.angular_rate_B_rad_s, limits.angular_rate_rad_s)) return Refusal::impossible;
  if (any_beyond(s.specific_force_B_m_s2, limits.specific_force_m_s2)) return Refusal::impossible;
  if (s.delta_time_s <= 0.0 || s.delta_time_s > 1.0) return Refusal::impossible;
  return std::nullopt;
}

}  // namespace fathom::bridge
