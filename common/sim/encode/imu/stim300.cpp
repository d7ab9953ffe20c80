#include "sim/encode/imu/stim300.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/bytes/big_endian.hpp"
#include "base/unknown.hpp"
#include "codec/imu/stim300.hpp"

namespace fathom::sim::encode {
namespace {

namespace stim = codec::stim300;
using Datagram = std::vector<std::uint8_t>;

constexpr double kMostCounts = 8'388'607.0;

void put_triad(Datagram& out, const std::array<double, 3>& values, double unit) {
  unsigned status = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double counts = std::round(values[axis] / unit);
    if (!known(counts)) status |= stim::channel_error | 1U << axis;
    if (std::abs(counts) > kMostCounts) status |= stim::overload | 1U << axis;
    const auto sent =
        known(counts) ? static_cast<std::int32_t>(std::clamp(counts, -kMostCounts, kMostCounts)) : 0;
    const auto bits = static_cast<std::uint32_t>(sent);
    for (const unsigned shift : {16U, 8U, 0U}) out.push_back(static_cast<std::uint8_t>(bits >> shift));
  }
  out.push_back(static_cast<std::uint8_t>(status));
}

void put_temperatures(Datagram& out, double temperature_degC) {
  const auto counts = static_cast<std::int16_t>(
      std::clamp(std::round(temperature_degC / stim::kTemperatureUnit_degC), -32'768.0, 32'767.0));
  for (int axis = 0; axis < 3; ++axis) append_be<std::int16_t>(out, counts);
  out.push_back(0);
}

void put_crc(Datagram& out) {
  append_be<std::uint32_t>(out, stim::crc32(out));
}

std::uint8_t range_code(double range_g) {
  return range_g == 5.0 ? 3 : range_g == 30.0 ? 4 : range_g == 80.0 ? 6 : 0;
}

}  // namespace

Datagram stim300(const ImuSample& s, const Stim300Frame& frame) {
  const bool temperatures = known(s.temperature_degC);
  const bool increments = frame.options.increments_hz > 0.0;
  const double range_g = frame.options.accel_range_g;
  Datagram out{static_cast<std::uint8_t>(temperatures ? 0xA5 : 0x91)};
  if (increments) {
    put_triad(out, s.delta_angle_B_rad, stim::angle_unit_rad());
    put_triad(out, s.delta_velocity_B_m_s, stim::velocity_unit_m_s(range_g));
  } else {
    put_triad(out, s.angular_rate_B_rad_s, stim::rate_unit_rad_s());
    put_triad(out, s.specific_force_B_m_s2, stim::force_unit_m_s2(range_g));
  }
  for (int triads = 0; temperatures && triads < 2; ++triads) put_temperatures(out, s.temperature_degC);
  out.push_back(frame.counter);
  append_be<std::uint16_t>(out, frame.latency_us);
  put_crc(out);
  if (frame.line) out.insert(out.end(), {'\r', '\n'});
  return out;
}

Datagram stim300_configuration(const codec::Stim300Options& options, std::uint8_t rate_code) {
  Datagram out(stim::kConfigurationLength - 4, 0);
  const std::uint8_t unit = options.increments_hz > 0.0 ? 1 : 0;
  const std::uint8_t range = range_code(options.accel_range_g);
  constexpr std::uint8_t kAxes = 0x70;
  out[0] = stim::kConfiguration;
  out[3] = static_cast<std::uint8_t>(rate_code << 5U | 2U);  // with accelerometers
  out[5] = kAxes | unit;
  out[8] = kAxes | unit;
  out[17] = static_cast<std::uint8_t>(range << 4U | range);
  out[18] = static_cast<std::uint8_t>(range << 4U);
  put_crc(out);
  return out;
}

}  // namespace fathom::sim::encode
