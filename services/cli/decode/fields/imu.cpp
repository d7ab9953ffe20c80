#include "samples/imu.hpp"

#include "cli/decode/fields.hpp"

namespace fathom::cli {

template <>
void add_fields(Json& line, const ImuSample& s) {
  constexpr std::array kAxes{'x', 'y', 'z'};
  for (std::size_t i = 0; i < 3; ++i) line[std::string{'g', kAxes[i]} + "_rad_s"] = s.angular_rate_B_rad_s[i];
  for (std::size_t i = 0; i < 3; ++i) line[std::string{'a', kAxes[i]} + "_m_s2"] = s.specific_force_B_m_s2[i];
  for (std::size_t i = 0; i < 3; ++i) {
    line[std::string("delta_angle_") + kAxes[i] + "_rad"] = s.delta_angle_B_rad[i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    line[std::string("delta_velocity_") + kAxes[i] + "_m_s"] = s.delta_velocity_B_m_s[i];
  }
  line["delta_time_s"] = s.delta_time_s;
  line["temperature_degC"] = s.temperature_degC;
}

}  // namespace fathom::cli
