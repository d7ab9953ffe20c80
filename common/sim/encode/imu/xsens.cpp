#include "sim/encode/imu/xsens.hpp"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include "base/bytes/big_endian.hpp"
#include "codec/imu/known3.hpp"
#include "codec/imu/xsens.hpp"
#include "sim/encode/pvt.hpp"

namespace fathom::sim::encode {
namespace {

using codec::known3;

namespace xbus = codec::xsens;
using Message = std::vector<std::uint8_t>;

void put_head(Message& data, std::uint16_t item, std::uint8_t size) {
  append_be<std::uint16_t>(data, item);
  data.push_back(size);
}

void put_float(Message& data, double value) {
  append_be<float>(data, static_cast<float>(value));
}

/// Forward, right, down into forward, left, up.
void put3(Message& data, std::uint16_t item, const std::array<double, 3>& v_B) {
  put_head(data, item, 12);
  put_float(data, v_B[0]);
  put_float(data, -v_B[1]);
  put_float(data, -v_B[2]);
}

void put_turn(Message& data, const std::array<double, 3>& angle_B_rad) {
  const double angle = std::hypot(angle_B_rad[0], angle_B_rad[1], angle_B_rad[2]);
  const double factor = angle > 0.0 ? std::sin(0.5 * angle) / angle : 0.5;
  put_head(data, xbus::Item::delta_q, 16);
  put_float(data, std::cos(0.5 * angle));
  put_float(data, factor * angle_B_rad[0]);
  put_float(data, -factor * angle_B_rad[1]);
  put_float(data, -factor * angle_B_rad[2]);
}

void put_utc(Message& data, TimeNs utc_ns) {
  const CivilTime civil = to_civil(utc_ns);
  put_head(data, xbus::Item::utc_time, 12);
  append_be<std::uint32_t>(data, static_cast<std::uint32_t>(civil.nanosecond));
  append_be<std::uint16_t>(data, static_cast<std::uint16_t>(civil.year));
  for (const int part : {civil.month, civil.day, civil.hour, civil.minute, civil.second})
    data.push_back(static_cast<std::uint8_t>(part));
  data.push_back(0x07);  // time of week, week and UTC valid
}

}  // namespace

Message xsens_message(std::uint8_t message, const Message& data) {
  assert(data.size() <= 2048);
  Message out{xbus::kPreamble, xbus::kMaster, message};
  if (data.size() < xbus::kExtendedLength) {
    out.push_back(static_cast<std::uint8_t>(data.size()));
  } else {
    out.push_back(xbus::kExtendedLength);
    append_be<std::uint16_t>(out, static_cast<std::uint16_t>(data.size()));
  }
  out.insert(out.end(), data.begin(), data.end());
  out.push_back(xbus::checksum(std::span(out).subspan(1)));
  return out;
}

Message xsens(const ImuSample& s, std::uint16_t counter, DurationNs since_startup_ns,
              std::optional<TimeNs> utc_ns) {
  assert(since_startup_ns >= 0);
  Message data;
  put_head(data, xbus::Item::packet_counter, 2);
  append_be<std::uint16_t>(data, counter);
  put_head(data, xbus::Item::sample_time_fine, 4);
  append_be<std::uint32_t>(
      data, static_cast<std::uint32_t>(static_cast<std::uint64_t>(since_startup_ns) / xbus::kTick_ns));
  if (utc_ns) put_utc(data, *utc_ns);
  if (known3(s.specific_force_B_m_s2)) put3(data, xbus::Item::acceleration, s.specific_force_B_m_s2);
  if (known3(s.angular_rate_B_rad_s)) put3(data, xbus::Item::rate_of_turn, s.angular_rate_B_rad_s);
  if (known3(s.delta_angle_B_rad) && known3(s.delta_velocity_B_m_s)) {
    put3(data, xbus::Item::delta_v, s.delta_velocity_B_m_s);
    put_turn(data, s.delta_angle_B_rad);
  }
  if (known(s.temperature_degC)) {
    put_head(data, xbus::Item::temperature, 4);
    put_float(data, s.temperature_degC);
  }
  return xsens_message(xbus::kMtData2, data);
}

Message xsens_fix(const GpsSample& sample, TimeNs utc_ns) {
  constexpr std::size_t kSatellitesAt = 22;
  Message item = pvt_fields(sample, utc_ns, std::endian::big, kSatellitesAt);
  append_be<std::uint32_t>(item, 0);  // accuracy of the heading
  append_be<std::int32_t>(item, 0);   // heading of the vehicle
  // Geometric, position, time, vertical, horizontal, northing, easting: as if all were the horizontal one.
  while (item.size() < xbus::kGnssPvtBytes) append_be<std::uint16_t>(item, pvt_dilution(sample.hdop));
  Message data;
  put_head(data, xbus::Item::gnss_pvt, static_cast<std::uint8_t>(item.size()));
  data.insert(data.end(), item.begin(), item.end());
  return xsens_message(xbus::kMtData2, data);
}

Message xsens_together(const Message& first, const Message& second) {
  Message data;
  for (const Message& message : {first, second}) {
    const bool extended = message[3] == xbus::kExtendedLength;
    data.insert(data.end(), message.begin() + (extended ? 6 : 4), message.end() - 1);
  }
  return xsens_message(xbus::kMtData2, data);
}

}  // namespace fathom::sim::encode
