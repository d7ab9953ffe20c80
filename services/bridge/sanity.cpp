#include "bridge/sanity.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "bridge/sanity/judge.hpp"

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

std::string sentence(const Refused& refused) {
  const auto number = [](double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%g", value);
    return std::string(text.data());
  };
  std::string out(refused.field);
  if (refused.index) out += "[" + std::to_string(*refused.index) + "]";
  if (std::isnan(refused.value)) return out + " is unknown, expected a number";
  if (std::isinf(refused.value)) return out + " is infinite, expected a number";
  out += " is " + number(refused.value) + ", expected ";
  if (std::isfinite(refused.most)) return out + number(refused.least) + " to " + number(refused.most);
  return out + (refused.least > 0.0 ? "more than 0" : "at least " + number(refused.least));
}

std::optional<Refused> refuse(const AnySample& sample, const config::SampleLimits& limits) {
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
