#include "sim/encode/imu/microstrain.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "base/bytes/big_endian.hpp"
#include "base/units.hpp"
#include "codec/fletcher.hpp"
#include "codec/gps_time.hpp"
#include "codec/imu/known3.hpp"
#include "codec/imu/microstrain.hpp"
#include "codec/imu/microstrain_gnss.hpp"

namespace fathom::sim::encode {
namespace {

using codec::known3;

namespace mip = codec::microstrain;
using Packet = std::vector<std::uint8_t>;

void put_mip_head(Packet& fields, std::uint8_t descriptor, std::uint8_t data_size) {
  fields.push_back(static_cast<std::uint8_t>(data_size + 2));
  fields.push_back(descriptor);
}

void put_mip_ns(Packet& fields, std::uint8_t descriptor, DurationNs ns) {
  put_mip_head(fields, descriptor, 8);
  append_be<std::uint64_t>(fields, static_cast<std::uint64_t>(ns));
}

void put_mip3(Packet& fields, std::uint8_t descriptor, const std::array<double, 3>& v_B, double unit = 1.0) {
  if (!known3(v_B)) return;
  put_mip_head(fields, descriptor, 12);
  for (const double x : v_B) append_be<float>(fields, static_cast<float>(x / unit));
}

void put_mip_gps_time(Packet& fields, std::uint8_t descriptor, TimeNs utc_ns) {
  const DurationNs gps_ns = codec::gps_of_utc(utc_ns);
  put_mip_head(fields, descriptor, 12);
  append_be<double>(fields, to_seconds(gps_ns % codec::kGpsWeek_ns));
  append_be<std::uint16_t>(fields, static_cast<std::uint16_t>(gps_ns / codec::kGpsWeek_ns));
  append_be<std::uint16_t>(fields, 0x0003);  // time of week and week are set
}

mip::FixType mip_fix_type(GpsFix fix) {
  switch (fix) {
    case GpsFix::none:
      return mip::FixType::none;
    case GpsFix::time_only:
      return mip::FixType::time_only;
    case GpsFix::dead_reckoning:
      return mip::FixType::invalid;
    case GpsFix::fix_2d:
      return mip::FixType::fix_2d;
    case GpsFix::fix_3d:
      return mip::FixType::fix_3d;
    case GpsFix::differential:
      return mip::FixType::differential;
    case GpsFix::rtk_float:
      return mip::FixType::rtk_float;
    case GpsFix::rtk_fixed:
      return mip::FixType::rtk_fixed;
  }
  return mip::FixType::none;
}

/// Numbers of a field, and at its end for each of them the flag that says whether it is known.
class MipNumbers {
 public:
  template <class T>
  void put(Packet& fields, double value) {
    append_be<T>(fields, static_cast<T>(known(value) ? value : 0.0));
    add(known(value));
  }
  void add(bool is_known) {
    if (is_known) flags_ |= 1U << count_;
    ++count_;
  }
  void put_flags(Packet& fields) const {
    append_be<std::uint16_t>(fields, static_cast<std::uint16_t>(flags_));
  }

 private:
  unsigned flags_ = 0;
  unsigned count_ = 0;
};

void put_mip_position(Packet& fields, const GpsSample& s) {
  put_mip_head(fields, mip::GnssField::position_llh, 42);
  const bool placed = known(s.latitude_rad) && known(s.longitude_rad);
  MipNumbers numbers;
  append_be<double>(fields, placed ? s.latitude_rad * kDegPerRad : 0.0);
  append_be<double>(fields, placed ? s.longitude_rad * kDegPerRad : 0.0);
  numbers.add(placed);
  numbers.put<double>(fields, s.altitude_m);
  numbers.put<double>(fields, s.altitude_msl_m);
  numbers.put<float>(fields, std::max(s.position_sigma_N_m[0], s.position_sigma_N_m[1]));
  numbers.put<float>(fields, s.position_sigma_N_m[2]);
  numbers.put_flags(fields);
}

void put_mip_velocity(Packet& fields, const GpsSample& s) {
  put_mip_head(fields, mip::GnssField::velocity_ned, 34);
  const auto& v = s.velocity_N_m_s;
  const auto& sigma = s.velocity_sigma_N_m_s;
  MipNumbers numbers;
  for (const double v_m_s : v) append_be<float>(fields, static_cast<float>(known3(v) ? v_m_s : 0.0));
  numbers.add(known3(v));
  numbers.put<float>(fields, std::hypot(v[0], v[1], v[2]));
  numbers.put<float>(fields, std::hypot(v[0], v[1]));
  numbers.put<float>(fields, s.course_rad * kDegPerRad);
  numbers.put<float>(fields, std::max({sigma[0], sigma[1], sigma[2]}));
  numbers.put<float>(fields, kUnknown);
  numbers.put_flags(fields);
}

}  // namespace

Packet microstrain_packet(std::uint8_t descriptor_set, const Packet& fields) {
  assert(fields.size() <= 255);
  Packet out;
  out.reserve(fields.size() + 6);
  for (const std::uint8_t byte : mip::kSync) out.push_back(byte);
  out.push_back(descriptor_set);
  out.push_back(static_cast<std::uint8_t>(fields.size()));
  out.insert(out.end(), fields.begin(), fields.end());
  for (const std::uint8_t byte : codec::fletcher8(out)) out.push_back(byte);
  return out;
}

Packet microstrain(const ImuSample& s, DurationNs since_startup_ns, std::optional<TimeNs> utc_ns) {
  assert(since_startup_ns >= 0);
  Packet fields;
  put_mip_ns(fields, mip::Field::reference_time, since_startup_ns);
  if (known(s.delta_time_s)) {
    put_mip_ns(fields, mip::Field::reference_time_delta, from_seconds(s.delta_time_s));
  }
  if (utc_ns) put_mip_gps_time(fields, mip::Field::shared_gps_timestamp, *utc_ns);
  put_mip3(fields, mip::Field::scaled_accel, s.specific_force_B_m_s2, kStandardGravity_m_s2);
  put_mip3(fields, mip::Field::scaled_gyro, s.angular_rate_B_rad_s);
  put_mip3(fields, mip::Field::delta_theta, s.delta_angle_B_rad);
  put_mip3(fields, mip::Field::delta_velocity, s.delta_velocity_B_m_s, kStandardGravity_m_s2);
  return microstrain_packet(mip::kSensorData, fields);
}

Packet microstrain_gnss(const GpsSample& s, TimeNs utc_ns, std::uint8_t descriptor_set) {
  Packet fields;
  put_mip_gps_time(fields, mip::GnssField::gps_time, utc_ns);
  put_mip_head(fields, mip::GnssField::fix_info, 6);
  fields.push_back(static_cast<std::uint8_t>(mip_fix_type(s.fix)));
  fields.push_back(static_cast<std::uint8_t>(std::clamp(s.satellites, 0, 255)));
  append_be<std::uint16_t>(fields, 0);  // corrections are said by the type
  append_be<std::uint16_t>(fields, s.satellites < 0 ? 0x0005 : 0x0007);
  put_mip_position(fields, s);
  put_mip_velocity(fields, s);
  put_mip_head(fields, mip::GnssField::dilution, 30);
  MipNumbers numbers;
  for (int i = 0; i < 7; ++i) numbers.put<float>(fields, i == 2 ? s.hdop : kUnknown);
  numbers.put_flags(fields);
  return microstrain_packet(descriptor_set, fields);
}

}  // namespace fathom::sim::encode
