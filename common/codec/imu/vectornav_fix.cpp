#include "codec/imu/vectornav_fix.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/bytes/little_endian.hpp"
#include "base/time.hpp"
#include "base/units.hpp"
#include "codec/gps_time.hpp"

namespace fathom::codec::vectornav {
namespace {

namespace field = gnss_field;
using Fields = Layout::Fields;

constexpr std::size_t kHdop = 4;  // of GDOP, PDOP, TDOP, VDOP, HDOP, NDOP, EDOP

std::optional<GpsFix> gps_fix_of(std::uint8_t code) {
  switch (code) {
    case 0:
      return GpsFix::none;
    case 1:
      return GpsFix::time_only;
    case 2:
      return GpsFix::fix_2d;
    case 3:
      return GpsFix::fix_3d;
    case 4:  // SBAS
      return GpsFix::differential;
    case 7:
      return GpsFix::rtk_float;
    case 8:
      return GpsFix::rtk_fixed;
    default:
      return std::nullopt;
  }
}

/// A standard deviation or a dilution; unknown where it is none.
double positive(Bytes frame, std::size_t at) {
  const double value = load_le<float>(frame, at);
  return std::isfinite(value) && value > 0.0 ? value : kUnknown;
}

/// Tow and week where they are there, else TimeUtc, as TimeInfo vouches for them. Without TimeInfo a fix
/// does.
std::optional<RejectReason> read_time(Bytes frame, const Fields& group, GpsFix fix, DeviceTime& time) {
  const std::size_t info = group[field::time_info];
  if (!info && fix == GpsFix::none) return std::nullopt;
  const std::uint8_t status = info ? frame[info] : time_ok | date_ok | utc_ok;
  if (group[field::tow] && group[field::week]) {
    if ((status & (time_ok | date_ok)) != (time_ok | date_ok)) return std::nullopt;
    const auto tow_ns = load_le<std::uint64_t>(frame, group[field::tow]);
    const auto week = load_le<std::uint16_t>(frame, group[field::week]);
    if (tow_ns <= static_cast<std::uint64_t>(kGpsWeek_ns) && week <= kLastGpsWeek)
      time.utc_ns = utc_of_gps(week * kGpsWeek_ns + static_cast<DurationNs>(tow_ns));
  } else if (group[field::utc] && (status & utc_ok) != 0) {
    time.utc_ns = utc_of_civil(frame, group[field::utc]);
  } else {
    return std::nullopt;
  }
  return info && !time.utc_ns ? std::optional(RejectReason::out_of_range) : std::nullopt;
}

std::optional<RejectReason> read_position(Bytes frame, const Fields& group, GpsSample& sample) {
  const std::size_t at = group[field::pos_lla];
  if (!at) return std::nullopt;
  const auto latitude_deg = load_le<double>(frame, at);
  const auto longitude_deg = load_le<double>(frame, at + 8);
  const auto altitude_m = load_le<double>(frame, at + 16);
  if (!std::isfinite(latitude_deg) || !std::isfinite(longitude_deg) || !std::isfinite(altitude_m)) {
    return RejectReason::field;
  }
  if (std::abs(latitude_deg) > 90.0 || std::abs(longitude_deg) > 180.0) return RejectReason::out_of_range;
  sample.latitude_rad = latitude_deg * kRadPerDeg;
  sample.longitude_rad = longitude_deg * kRadPerDeg;
  sample.altitude_m = altitude_m;
  if (const std::size_t sigma = group[field::pos_u]) {
    for (std::size_t i = 0; i < 3; ++i) sample.position_sigma_N_m[i] = positive(frame, sigma + 4 * i);
  }
  return std::nullopt;
}

std::optional<RejectReason> read_velocity(Bytes frame, const Fields& group, GpsSample& sample) {
  const std::size_t at = group[field::vel_ned];
  if (!at) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    sample.velocity_N_m_s[i] = load_le<float>(frame, at + 4 * i);
    if (!std::isfinite(sample.velocity_N_m_s[i])) return RejectReason::field;
  }
  if (const std::size_t sigma = group[field::vel_u]) {
    sample.velocity_sigma_N_m_s.fill(positive(frame, sigma));
  }
  return std::nullopt;
}

std::optional<RejectReason> read_fix(Bytes frame, const Fields& group, GpsSample& sample, DeviceTime& time) {
  const auto fix = gps_fix_of(frame[group[field::fix]]);
  if (!fix) return RejectReason::field;
  sample.fix = *fix;
  if (group[field::num_sats]) sample.satellites = frame[group[field::num_sats]];
  if (const auto reason = read_time(frame, group, *fix, time)) return reason;
  if (*fix < GpsFix::fix_2d) return std::nullopt;
  if (const auto reason = read_position(frame, group, sample)) return reason;
  if (const auto reason = read_velocity(frame, group, sample)) return reason;
  if (const std::size_t at = group[field::dop]) sample.hdop = positive(frame, at + 4 * kHdop);
  return std::nullopt;
}

bool is_fix(const Fields& group) {
  return group[field::fix] && (group[field::pos_lla] || group[field::vel_ned]);
}

}  // namespace

std::optional<TimeNs> utc_of_civil(Bytes frame, std::size_t at) {
  CivilTime civil;
  civil.year = 2000 + load_le<std::int8_t>(frame, at);
  civil.month = frame[at + 1];
  civil.day = frame[at + 2];
  civil.hour = frame[at + 3];
  civil.minute = frame[at + 4];
  civil.second = frame[at + 5];
  civil.nanosecond = load_le<std::int16_t>(frame, at + 6) * kNsPerMillisecond;
  return from_civil(civil);
}

Fixes::Key Fixes::key_of(Bytes frame, const Fields& group) {
  Key key;
  key.fix = frame[group[field::fix]];
  auto end = key.bytes.begin();
  const auto put = [&](std::size_t at, std::size_t size) {
    if (at) end = std::copy_n(frame.begin() + static_cast<std::ptrdiff_t>(at), size, end);
  };
  if (group[field::tow]) {
    key.kind = Key::Kind::tow;
    put(group[field::tow], 8);
  } else if (group[field::utc]) {
    key.kind = Key::Kind::utc;
    put(group[field::utc], 8);
  } else {
    key.kind = Key::Kind::values;
    put(group[field::pos_lla], 24);
    put(group[field::vel_ned], 12);
    put(group[field::num_sats], 1);
  }
  return key;
}

std::optional<Fixes::Found> Fixes::take(Bytes frame, const Layout& layout) {
  const Fields& first = layout.at[Group::gnss1];
  if (is_fix(first) && !std::exchange(has_gnss1_, true)) last_ = {};
  const Fields& group = has_gnss1_ ? first : layout.at[Group::gnss2];
  if (!is_fix(group)) return std::nullopt;
  const Key key = key_of(frame, group);
  if (key == last_ || key.kind < last_.kind) return std::nullopt;
  last_ = key;
  Found found;
  found.refused = read_fix(frame, group, found.sample, found.time);
  return found;
}

}  // namespace fathom::codec::vectornav
