#include "sim/encode/imu/microstrain.hpp"

#include <array>
#include <cassert>

#include "base/bytes/big_endian.hpp"
#include "base/units.hpp"
#include "codec/fletcher.hpp"
#include "codec/gps_time.hpp"
#include "codec/imu/known3.hpp"
#include "codec/imu/microstrain.hpp"

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
  if (utc_ns) {
    const DurationNs gps_ns = codec::gps_of_utc(*utc_ns);
    put_mip_head(fields, mip::Field::shared_gps_timestamp, 12);
    append_be<double>(fields, to_seconds(gps_ns % codec::kGpsWeek_ns));
    append_be<std::uint16_t>(fields, static_cast<std::uint16_t>(gps_ns / codec::kGpsWeek_ns));
    append_be<std::uint16_t>(fields, 0x0003);  // time of week and week are set
  }
  put_mip3(fields, mip::Field::scaled_accel, s.specific_force_B_m_s2, kStandardGravity_m_s2);
  put_mip3(fields, mip::Field::scaled_gyro, s.angular_rate_B_rad_s);
  put_mip3(fields, mip::Field::delta_theta, s.delta_angle_B_rad);
  put_mip3(fields, mip::Field::delta_velocity, s.delta_velocity_B_m_s, kStandardGravity_m_s2);
  return microstrain_packet(mip::kSensorData, fields);
}

}  // namespace fathom::sim::encode
