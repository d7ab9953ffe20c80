#include "bridge/sanity.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace fathom::bridge {
namespace {

using Verdict = std::optional<Refusal>;
using Limits = config::SampleLimits;

bool any_infinite(std::span<const double> values) {
  for (const double value : values) {
    if (std::isinf(value)) return true;
  }
  return false;
}

bool all_finite(std::span<const double> values) {
  for (const double value : values) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

// True for a known value beyond the limit; an unknown one breaks none.
bool beyond(double value, double limit) {
  return std::abs(value) > limit;
}

bool any_beyond(std::span<const double> values, double limit) {
  for (const double value : values) {
    if (beyond(value, limit)) return true;
  }
  return false;
}

Verdict position(double latitude_rad, double longitude_rad) {
  if (any_infinite(std::array{latitude_rad, longitude_rad})) return Refusal::not_finite;
  if (beyond(latitude_rad, std::numbers::pi / 2) || beyond(longitude_rad, std::numbers::pi)) {
    return Refusal::impossible;
  }
  return std::nullopt;
}

Verdict judge(const ImuSample& s, const Limits& limits) {
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

Verdict judge(const DvlSample& s, const Limits& limits) {
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

Verdict judge(const GpsSample& s, const Limits& limits) {
  if (any_infinite(s.velocity_N_m_s) || any_infinite(s.position_sigma_N_m) ||
      any_infinite(s.velocity_sigma_N_m_s) ||
      any_infinite(std::array{s.altitude_m, s.altitude_msl_m, s.hdop})) {
    return Refusal::not_finite;
  }
  if (any_beyond(s.velocity_N_m_s, limits.gps_speed_m_s)) return Refusal::impossible;
  constexpr double kLowest_m = -1'000.0;
  constexpr double kHighest_m = 100'000.0;
  for (const double altitude_m : {s.altitude_m, s.altitude_msl_m}) {
    if (altitude_m < kLowest_m || altitude_m > kHighest_m) return Refusal::impossible;
  }
  return position(s.latitude_rad, s.longitude_rad);
}

Verdict judge(const DepthSample& s, const Limits& limits) {
  constexpr double kHighest_m = 100.0;  // a vehicle may be in the air before it is in the water
  if (!std::isfinite(s.depth_m)) return Refusal::not_finite;
  if (s.depth_m > limits.depth_m || s.depth_m < -kHighest_m) return Refusal::impossible;
  return std::nullopt;
}

Verdict judge(const HeadingSample& s, const Limits&) {
  if (!std::isfinite(s.heading_rad)) return Refusal::not_finite;
  if (s.heading_rad < 0.0 || s.heading_rad >= 2.0 * std::numbers::pi) return Refusal::impossible;
  return std::nullopt;
}

Verdict judge(const UsblSample& s, const Limits& limits) {
  const bool geodetic = s.frame == UsblFrame::geodetic;
  const bool polar = !geodetic && (known(s.range_m) || known(s.bearing_rad));
  const std::array where{geodetic ? s.latitude_rad : s.relative_m[0],
                         geodetic ? s.longitude_rad : s.relative_m[1]};
  if ((!polar && !all_finite(where)) ||
      any_infinite(std::array{s.depth_m, s.sigma_m, s.travel_time_s, s.relative_m[2], s.range_m,
                              s.bearing_rad, s.depression_rad, s.sigma_rad, s.station_depth_m}) ||
      any_infinite(s.station_rpy_rad)) {
    return Refusal::not_finite;
  }
  if (any_beyond(s.relative_m, limits.usbl_range_m) || beyond(s.depth_m, limits.depth_m) || s.sigma_m < 0.0 ||
      s.range_m <= 0.0 || beyond(s.range_m, limits.usbl_range_m) ||
      beyond(s.depression_rad, 0.5 * std::numbers::pi) || beyond(s.bearing_rad, 2.0 * std::numbers::pi)) {
    return Refusal::impossible;
  }
  if (const Verdict verdict = position(s.station_latitude_rad, s.station_longitude_rad)) return verdict;
  return position(s.latitude_rad, s.longitude_rad);
}

Verdict judge(const PropulsionSample& s, const Limits& limits) {
  if (!std::isfinite(s.rpm)) return Refusal::not_finite;
  if (beyond(s.rpm, limits.rpm)) return Refusal::impossible;
  return std::nullopt;
}

Verdict judge(const FinsSample& s, const Limits& limits) {
  const std::array fins{s.rudder_rad, s.stern_rad};
  if (any_infinite(fins) || (!known(fins[0]) && !known(fins[1]))) return Refusal::not_finite;
  if (any_beyond(fins, limits.fin_rad)) return Refusal::impossible;
  return std::nullopt;
}

Verdict judge(const AirspeedSample& s, const Limits& limits) {
  const std::array speeds{s.airspeed_m_s, s.true_airspeed_m_s};
  if (any_infinite(speeds) || (!known(speeds[0]) && !known(speeds[1])) || std::isinf(s.baro_altitude_m))
    return Refusal::not_finite;
  if (any_beyond(speeds, limits.airspeed_m_s) || s.sigma_m_s < 0.0) return Refusal::impossible;
  return std::nullopt;
}

}  // namespace

std::string_view to_string(Refusal refusal) {
  return refusal == Refusal::not_finite ? "not_finite" : "impossible";
}

std::optional<Refusal> refuse(const codec::AnySample& sample, const config::SampleLimits& limits) {
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
