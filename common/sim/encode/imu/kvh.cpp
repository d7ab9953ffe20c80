#include "sim/encode/imu/kvh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/bytes/big_endian.hpp"
#include "base/units.hpp"
#include "base/unknown.hpp"
#include "codec/byte_sum.hpp"
#include "codec/crc32.hpp"

namespace fathom::sim::encode {
namespace {

namespace kvh_layout = codec::kvh;

/// Which of the three are valid, from bit 0 on.
unsigned put_kvh_triad(std::vector<std::uint8_t>& out, const std::array<double, 3>& values, double unit) {
  unsigned valid = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const bool is_known = known(values[axis]);
    append_be<float>(out, is_known ? static_cast<float>(values[axis] / unit) : 0.0F);
    if (is_known) valid |= 1U << axis;
  }
  return valid;
}

}  // namespace

std::vector<std::uint8_t> kvh(const ImuSample& s, const KvhMessage& message) {
  using kvh_layout::Format;
  const codec::KvhOptions& options = message.options;
  const auto sequence = static_cast<std::uint8_t>(message.sequence % kvh_layout::kSequences);
  const double reading =
      known(s.temperature_degC) ? kvh_layout::from_degC(s.temperature_degC, options.temperature) : 0.0;

  std::vector<std::uint8_t> out{kvh_layout::kFirst, kvh_layout::kSecond, kvh_layout::kData,
                                static_cast<std::uint8_t>(message.format)};
  unsigned valid = put_kvh_triad(out, s.angular_rate_B_rad_s, kvh_layout::rotation_unit_rad_s(options));
  valid |= put_kvh_triad(out, s.specific_force_B_m_s2, kStandardGravity_m_s2)
           << kvh_layout::kFirstAccelerometer;
  if (message.format == Format::b) append_be<std::uint32_t>(out, message.clock_us);
  if (message.format == Format::c)
    append_be<float>(
        out, kvh_layout::has_temperature(message.format, sequence) ? static_cast<float>(reading) : 0.0F);
  out.push_back(static_cast<std::uint8_t>(valid));
  out.push_back(sequence);
  if (message.format != Format::c) {
    append_be<std::int16_t>(out,
                            static_cast<std::int16_t>(std::clamp(std::round(reading), -32'768.0, 32'767.0)));
  }
  append_be<std::uint32_t>(out, codec::crc32_mpeg2(out));
  return out;
}

std::vector<std::uint8_t> kvh_test(bool longer) {
  constexpr std::uint8_t kPassed = 0x7F;
  std::vector<std::uint8_t> out{kvh_layout::kFirst, kvh_layout::kSecond, kvh_layout::kTest,
                                longer ? kvh_layout::kLongTest : kvh_layout::kShortTest};
  out.resize(out.size() + (longer ? 8 : 6), kPassed);
  out.push_back(static_cast<std::uint8_t>(codec::byte_sum(out)));
  return out;
}

}  // namespace fathom::sim::encode
