#include "sim/encode/imu/vectornav.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <span>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/gps_time.hpp"
#include "codec/imu/known3.hpp"
#include "codec/imu/vectornav.hpp"
#include "codec/imu/vectornav_layout.hpp"
#include "sim/encode/decimal.hpp"

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

std::uint8_t fix_code(GpsFix fix) {
  switch (fix) {
    case GpsFix::none:
    case GpsFix::dead_reckoning:
      return 0;
    case GpsFix::time_only:
      return 1;
    case GpsFix::fix_2d:
      return 2;
    case GpsFix::fix_3d:
      return 3;
    case GpsFix::differential:
      return 4;
    case GpsFix::rtk_float:
      return 7;
    case GpsFix::rtk_fixed:
      return 8;
  }
  return 0;
}

constexpr std::uint16_t kGnssMask = 1U << vn::gnss_field::tow | 1U << vn::gnss_field::week |
                                    1U << vn::gnss_field::num_sats | 1U << vn::gnss_field::fix |
                                    1U << vn::gnss_field::pos_lla | 1U << vn::gnss_field::vel_ned |
                                    1U << vn::gnss_field::pos_u | 1U << vn::gnss_field::vel_u |
                                    1U << vn::gnss_field::time_info | 1U << vn::gnss_field::dop;

void put_gnss(std::vector<std::uint8_t>& payload, const VectornavFix& fix) {
  const GpsSample& s = fix.sample;
  const DurationNs gps_ns = codec::gps_of_utc(fix.utc_ns);
  append_le<std::uint64_t>(payload, static_cast<std::uint64_t>(gps_ns % codec::kGpsWeek_ns));
  append_le<std::uint16_t>(payload, static_cast<std::uint16_t>(gps_ns / codec::kGpsWeek_ns));
  payload.push_back(static_cast<std::uint8_t>(std::clamp(s.satellites, 0, 255)));
  payload.push_back(fix_code(s.fix));
  append_le<double>(payload, zero_if_unknown(s.latitude_rad * kDegPerRad));
  append_le<double>(payload, zero_if_unknown(s.longitude_rad * kDegPerRad));
  append_le<double>(payload, zero_if_unknown(s.altitude_m));
  for (const double v : s.velocity_N_m_s) append_le<float>(payload, static_cast<float>(zero_if_unknown(v)));
  for (const double v : s.position_sigma_N_m)
    append_le<float>(payload, static_cast<float>(zero_if_unknown(v)));
  const auto& sigma = s.velocity_sigma_N_m_s;
  append_le<float>(payload, static_cast<float>(zero_if_unknown(std::max({sigma[0], sigma[1], sigma[2]}))));
  payload.push_back(0x07);  // time, date and UTC valid
  payload.push_back(static_cast<std::uint8_t>(codec::kGpsAheadOfUtc_ns / kNsPerSecond));
  // Geometric, position, time, vertical, horizontal, north, east: as if all were the horizontal one.
  for (int i = 0; i < 7; ++i) append_le<float>(payload, static_cast<float>(zero_if_unknown(s.hdop)));
}

std::vector<std::uint8_t> framed(std::uint8_t groups, const std::vector<std::uint16_t>& masks,
                                 const std::vector<std::uint8_t>& payload) {
  std::vector<std::uint8_t> frame{vn::kSync, groups};
  for (const std::uint16_t mask : masks) append_le<std::uint16_t>(frame, mask);
  frame.insert(frame.end(), payload.begin(), payload.end());
  const std::uint16_t crc = codec::vectornav_crc16(std::span(frame).subspan(1));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  return frame;
}

}  // namespace

std::vector<std::uint8_t> vectornav(const ImuSample& s, DurationNs since_startup_ns,
                                    std::optional<TimeNs> utc_ns, const VectornavFix* fix) {
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

  constexpr std::uint8_t kGroups = 1U << vn::Group::time | 1U << vn::Group::imu;
  if (!fix) return framed(kGroups, {time_mask, imu_mask}, payload);
  put_gnss(payload, *fix);
  return framed(kGroups | 1U << vn::Group::gnss1, {time_mask, imu_mask, kGnssMask}, payload);
}

std::vector<std::uint8_t> vectornav_fix(const VectornavFix& fix) {
  std::vector<std::uint8_t> payload;
  put_gnss(payload, fix);
  return framed(1U << vn::Group::gnss1, {kGnssMask}, payload);
}

}  // namespace fathom::sim::encode
