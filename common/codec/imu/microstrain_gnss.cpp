#include "codec/imu/microstrain_gnss.hpp"

#include <cmath>

#include "base/bytes/big_endian.hpp"
#include "base/units.hpp"
#include "codec/gps_time.hpp"
#include "codec/imu/microstrain.hpp"
#include "codec/satellite/receiver_numbers.hpp"

namespace fathom::codec::microstrain {

namespace {

/// The satellites' own augmentation or a reference station.
constexpr unsigned kCorrectionsUsed = 0x0003;

GpsFix fix_of_type(FixType type, bool corrected) {
  switch (type) {
    case FixType::fix_3d:
      return corrected ? GpsFix::differential : GpsFix::fix_3d;
    case FixType::fix_2d:
      return GpsFix::fix_2d;
    case FixType::time_only:
      return GpsFix::time_only;
    case FixType::rtk_float:
      return GpsFix::rtk_float;
    case FixType::rtk_fixed:
      return GpsFix::rtk_fixed;
    case FixType::differential:
      return GpsFix::differential;
    case FixType::none:
    case FixType::invalid:
      break;
  }
  return GpsFix::none;
}

}  // namespace

bool week_and_time_valid(std::uint16_t flags) {
  constexpr unsigned kTimeOfWeekAndWeek = 0x0003;
  return (flags & kTimeOfWeekAndWeek) == kTimeOfWeekAndWeek;
}

std::optional<RejectReason> read_gps_time(Bytes data, bool (*is_valid)(std::uint16_t),
                                          std::optional<GpsTime>& into) {
  if (data.size() != 12) return RejectReason::structure;
  const auto time_of_week_s = load_be<double>(data, 0);
  const auto week = load_be<std::uint16_t>(data, 8);
  const bool valid = is_valid(load_be<std::uint16_t>(data, 10));
  const double since_epoch_s = week * to_seconds(kGpsWeek_ns) + time_of_week_s;
  // A number at all, and one that 64 bits of nanoseconds hold.
  const bool possible = time_of_week_s >= 0.0 && since_epoch_s <= kLastGpsWeek * to_seconds(kGpsWeek_ns);
  if (valid && !std::isfinite(time_of_week_s)) return RejectReason::field;
  if (valid && !(possible && time_of_week_s <= to_seconds(kGpsWeek_ns))) return RejectReason::out_of_range;
  if (possible) into = GpsTime{week * kGpsWeek_ns + from_seconds(time_of_week_s), valid};
  return std::nullopt;
}

std::optional<RejectReason> GnssData::take(std::uint8_t descriptor, Bytes data) {
  switch (descriptor) {
    case GnssField::position_llh:
      return take_position(data);
    case GnssField::velocity_ned:
      return take_velocity(data);
    case GnssField::dilution:
      return take_dilution(data);
    case GnssField::utc_time:
      return take_utc(data);
    case GnssField::gps_time:
      return read_gps_time(data, week_and_time_valid, gps_);
    case GnssField::fix_info:
      return take_fix_info(data);
    case Field::event_source:
      if (data.size() != 1) return RejectReason::structure;
      event_ = data[0];
      return std::nullopt;
    default:
      return std::nullopt;
  }
}

std::optional<RejectReason> GnssData::take_position(Bytes data) {
  if (data.size() != 42) return RejectReason::structure;
  const unsigned flags = load_be<std::uint16_t>(data, 40);
  const bool placed = (flags & 0x01U) != 0;
  NumberCheck check;
  got_.latitude_rad = kRadPerDeg * check.take(placed, load_be<double>(data, 0), -90.0, 90.0);
  got_.longitude_rad = kRadPerDeg * check.take(placed, load_be<double>(data, 8), -180.0, 180.0);
  const auto height = [&](unsigned flag, std::size_t at) {
    return check.take((flags & flag) != 0, load_be<double>(data, at), -kMostHeight_m, kMostHeight_m);
  };
  got_.altitude_m = height(0x02U, 16);
  got_.altitude_msl_m = height(0x04U, 24);
  const double horizontal_m = check.take_sigma((flags & 0x08U) != 0, load_be<float>(data, 32));
  const double vertical_m = check.take_sigma((flags & 0x10U) != 0, load_be<float>(data, 36));
  got_.position_sigma_N_m = {horizontal_m, horizontal_m, vertical_m};
  has_position_ = true;
  return check.reason();
}

std::optional<RejectReason> GnssData::take_velocity(Bytes data) {
  if (data.size() != 34) return RejectReason::structure;
  const unsigned flags = load_be<std::uint16_t>(data, 32);
  NumberCheck check;
  for (std::size_t i = 0; i < 3; ++i) {
    got_.velocity_N_m_s[i] =
        check.take((flags & 0x01U) != 0, load_be<float>(data, 4 * i), -kMostVelocity_m_s, kMostVelocity_m_s);
  }
  got_.course_rad =
      as_course(kRadPerDeg * check.take((flags & 0x08U) != 0, load_be<float>(data, 20), -360.0, 360.0));
  got_.velocity_sigma_N_m_s.fill(check.take_sigma((flags & 0x10U) != 0, load_be<float>(data, 24)));
  return check.reason();
}

std::optional<RejectReason> GnssData::take_dilution(Bytes data) {
  if (data.size() != 30) return RejectReason::structure;
  const unsigned flags = load_be<std::uint16_t>(data, 28);
  NumberCheck check;
  got_.hdop = check.take_sigma((flags & 0x04U) != 0, load_be<float>(data, 8));
  return check.reason();
}

std::optional<RejectReason> GnssData::take_utc(Bytes data) {
  constexpr unsigned kDateAndLeapSeconds = 0x0003;
  if (data.size() != 13) return RejectReason::structure;
  if ((load_be<std::uint16_t>(data, 11) & kDateAndLeapSeconds) != kDateAndLeapSeconds) return std::nullopt;
  constexpr int kLeapSecond = 60;
  if (data[6] == kLeapSecond) return std::nullopt;  // no instant of Unix time
  const auto millisecond = load_be<std::uint32_t>(data, 7);
  if (millisecond > 999) return RejectReason::out_of_range;
  utc_ns_ = from_civil({.year = load_be<std::uint16_t>(data, 0),
                        .month = data[2],
                        .day = data[3],
                        .hour = data[4],
                        .minute = data[5],
                        .second = data[6],
                        .nanosecond = static_cast<int>(millisecond * kNsPerMillisecond)});
  return utc_ns_ ? std::nullopt : std::optional(RejectReason::out_of_range);
}

std::optional<RejectReason> GnssData::take_fix_info(Bytes data) {
  if (data.size() != 6) return RejectReason::structure;
  const unsigned valid = load_be<std::uint16_t>(data, 4);
  told_fix_ = GpsFix::none;
  if ((valid & 0x01U) != 0) {
    if (data[0] > static_cast<std::uint8_t>(FixType::differential)) return RejectReason::field;
    const bool corrected = (valid & 0x04U) != 0 && (load_be<std::uint16_t>(data, 2) & kCorrectionsUsed) != 0;
    told_fix_ = fix_of_type(static_cast<FixType>(data[0]), corrected);
  }
  if ((valid & 0x02U) != 0) got_.satellites = data[1];
  return std::nullopt;
}

GpsFix GnssData::fix() const {
  const bool placed = known(got_.latitude_rad);
  if (!told_fix_) {
    if (!placed) return GpsFix::none;
    return known(got_.altitude_m) || known(got_.altitude_msl_m) ? GpsFix::fix_3d : GpsFix::fix_2d;
  }
  return placed || *told_fix_ <= GpsFix::time_only ? *told_fix_ : GpsFix::none;
}

GpsSample GnssData::sample() const {
  const GpsFix told = fix();
  if (told >= GpsFix::dead_reckoning) {
    GpsSample out = got_;
    out.fix = told;
    return out;
  }
  GpsSample out;
  out.fix = told;
  out.satellites = got_.satellites;
  return out;
}

DeviceTime GnssData::time() const {
  DeviceTime time;
  if (gps_ && gps_->valid) {
    time.utc_ns = utc_of_gps(gps_->since_epoch_ns);
  } else {
    time.utc_ns = utc_ns_;
  }
  return time;
}

}  // namespace fathom::codec::microstrain
