#include "sim/encode/imu/vectornav.hpp"

#include <array>
#include <cassert>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/gps_time.hpp"
#include "codec/imu/known3.hpp"
#include "codec/imu/vectornav.hpp"
#include "codec/imu/vectornav_layout.hpp"

namespace fathom::sim::encode {
namespace {

using codec::known3;

namespace vn = codec::vectornav;

void append3(std::vector<std::uint8_t>& bytes, const std::array<double, 3>& v, double factor = 1.0) {
  for (const double x : v) append_le<float>(bytes, static_cast<float>(factor * x));
}

std::uint16_t bit(std::size_t field) {
  return static_cast<std::uint16_t>(1U << field);
}

}  // namespace

std::vector<std::uint8_t> vectornav(const ImuSample& s, DurationNs since_startup_ns,
                                    std::optional<TimeNs> utc_ns) {
  assert(since_startup_ns >= 0);
  // Fields follow in the order of groups and mask bits.
  std::uint16_t time_mask = bit(vn::time_field::startup);
  std::vector<std::uint8_t> payload;
  append_le<std::uint64_t>(payload, static_cast<std::uint64_t>(since_startup_ns));
  if (utc_ns) {
    time_mask |= bit(vn::time_field::gps) | bit(vn::time_field::status);
    append_le<std::uint64_t>(payload, static_cast<std::uint64_t>(codec::gps_of_utc(*utc_ns)));
    payload.push_back(0x07);  // time, date and UTC valid
  }
  std::uint16_t imu_mask = 0;
  if (known3(s.specific_force_B_m_s2)) {
    imu_mask |= bit(vn::imu_field::uncomp_accel);
    append3(payload, s.specific_force_B_m_s2);
  }
  if (known3(s.angular_rate_B_rad_s)) {
    imu_mask |= bit(vn::imu_field::uncomp_gyro);
    append3(payload, s.angular_rate_B_rad_s);
  }
  if (known(s.temperature_degC)) {
    imu_mask |= bit(vn::imu_field::temperature);
    append_le<float>(payload, static_cast<float>(s.temperature_degC));
  }
  if (known(s.delta_time_s) && known3(s.delta_angle_B_rad) && known3(s.delta_velocity_B_m_s)) {
    imu_mask |= bit(vn::imu_field::delta_theta) | bit(vn::imu_field::delta_velocity);
    append_le<float>(payload, static_cast<float>(s.delta_time_s));
    append3(payload, s.delta_angle_B_rad, kDegPerRad);
    append3(payload, s.delta_velocity_B_m_s);
  }

  std::vector<std::uint8_t> frame{vn::kSync};
  frame.push_back(static_cast<std::uint8_t>(1U << vn::Group::time | 1U << vn::Group::imu));
  append_le<std::uint16_t>(frame, time_mask);
  append_le<std::uint16_t>(frame, imu_mask);
  frame.insert(frame.end(), payload.begin(), payload.end());
  const std::uint16_t crc = codec::vectornav_crc16(std::span(frame).subspan(1));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  return frame;
}

}  // namespace fathom::sim::encode
