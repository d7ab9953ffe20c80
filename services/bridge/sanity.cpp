#include "bridge/sanity.hpp"

#include <array>

#include "bridge/sanity/limits.hpp"

namespace fathom::bridge {
std::string_view to_string(Refusal refusal) {
  switch (refusal) {
    case Refusal::not_finite:
      return "not_finite";
    case Refusal::impossible:
      return "impossible";
    case Refusal::no_instant:
      break;
  }
  return "no_instant";
}

std::optional<Refusal> refuse(const AnySample& sample, const config::SampleLimits& limits) {
  return std::visit([&](const auto& value) { return judge(value, limits); }, sample);
}

void rotate_into_body(ImuSample& sample, const std::array<double, 9>& R_BS) {
  const auto rotate = [&](std::array<double, 3>& v) {
    const std::array<double, 3> in = v;
    for (std::size_t row = 0; row < 3; ++row) {
      v[row] = 0.0;
      for (std::size_t column = 0; column < 3; ++column) {
        // An axis that takes no part must not carry its NaN into the others.
        if (R_BS[3 * row + column] != 0.0) v[row] += R_BS[3 * row + column] * in[column];
      }
    }
  };
  rotate(sample.angular_rate_B_rad_s);
  rotate(sample.specific_force_B_m_s2);
  rotate(sample.delta_angle_B_rad);
  rotate(sample.delta_velocity_B_m_s);
}

}  // namespace fathom::bridge
