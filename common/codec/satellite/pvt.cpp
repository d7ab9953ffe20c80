#include "codec/satellite/pvt.hpp"

#include <cmath>
#include <numbers>

#include "base/bytes/big_endian.hpp"
#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"

namespace fathom::codec {
namespace {

constexpr double kMilli = 1e-3;
constexpr unsigned kFixOk = 1;
constexpr unsigned kCorrected = 2;
constexpr unsigned kResolved = 7;

template <class T>
T load_as(Bytes bytes, std::size_t at, std::endian order) {
  return order == std::endian::big ? load_be<T>(bytes, at) : load_le<T>(bytes, at);
}

unsigned carrier(const Pvt& pvt) {
  return pvt.flags >> 6U;
}

GpsFix fix_of_pvt(const Pvt& pvt) {
  if ((pvt.flags & kFixOk) == 0 || pvt.position_invalid) return GpsFix::none;
  switch (pvt.fix_type) {
    case 1:
      return GpsFix::dead_reckoning;
    case 2:
      return GpsFix::fix_2d;
    case 3:
    case 4:
      if (carrier(pvt) == 2) return GpsFix::rtk_fixed;
      if (carrier(pvt) == 1) return GpsFix::rtk_float;
      return (pvt.flags & kCorrected) != 0 ? GpsFix::differential : GpsFix::fix_3d;
    case 5:
      return GpsFix::time_only;
    default:
      return GpsFix::none;
  }
}

}  // namespace

Pvt::Pvt(Bytes fields, std::endian order) {
  const auto u32 = [&](std::size_t at) { return load_as<std::uint32_t>(fields, at, order); };
  const auto i32 = [&](std::size_t at) { return load_as<std::int32_t>(fields, at, order); };
  civil = {.year = load_as<std::uint16_t>(fields, 4, order),
           .month = fields[6],
           .day = fields[7],
           .hour = fields[8],
           .minute = fields[9],
           .second = fields[10],
           .nanosecond = i32(16)};
  valid = fields[11];
  fix_type = fields[20];
  flags = fields[21];
  longitude_deg = i32(24) * 1e-7;
  latitude_deg = i32(28) * 1e-7;
  height_m = i32(32) * kMilli;
  height_msl_m = i32(36) * kMilli;
  horizontal_accuracy_m = u32(40) * kMilli;
  vertical_accuracy_m = u32(44) * kMilli;
  velocity_N_m_s = {i32(48) * kMilli, i32(52) * kMilli, i32(56) * kMilli};
  course_deg = i32(64) * 1e-5;
  speed_accuracy_m_s = u32(68) * kMilli;
}

std::optional<RejectReason> read_pvt(const Pvt& pvt, GpsSample& sample, DeviceTime& time) {
  if (pvt.fix_type > 5 || carrier(pvt) > 2) return RejectReason::field;
  if ((pvt.valid & kResolved) == kResolved) {
    time.utc_ns = from_civil(pvt.civil);
    if (!time.utc_ns) return RejectReason::out_of_range;
  }
  sample.fix = fix_of_pvt(pvt);
  sample.satellites = pvt.satellites;
  if (sample.fix < GpsFix::dead_reckoning) return std::nullopt;
  if (std::abs(pvt.latitude_deg) > 90.0 || std::abs(pvt.longitude_deg) > 180.0) {
    return RejectReason::out_of_range;
  }
  sample.latitude_rad = pvt.latitude_deg * kRadPerDeg;
  sample.longitude_rad = pvt.longitude_deg * kRadPerDeg;
  sample.altitude_m = pvt.height_m;
  sample.altitude_msl_m = pvt.height_msl_m;
  const double axis_m = pvt.horizontal_accuracy_m / std::numbers::sqrt2;
  sample.position_sigma_N_m = {axis_m, axis_m, pvt.vertical_accuracy_m};
  sample.velocity_N_m_s = pvt.velocity_N_m_s;
  sample.velocity_sigma_N_m_s.fill(pvt.speed_accuracy_m_s);
  sample.course_rad = pvt.course_deg * kRadPerDeg;
  sample.hdop = pvt.hdop;
  return std::nullopt;
}

}  // namespace fathom::codec
