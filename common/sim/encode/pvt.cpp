#include "sim/encode/pvt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/bytes/big_endian.hpp"
#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/gps_time.hpp"

namespace fathom::sim::encode {
namespace {

std::int32_t scaled(double value, double scale) {
  if (!known(value)) return 0;
  constexpr double kLimit = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::llround(std::clamp(value * scale, -kLimit, kLimit)));
}

/// An accuracy in thousandths; unknown is the largest number.
std::uint32_t accuracy(double value) {
  constexpr double kLimit = std::numeric_limits<std::uint32_t>::max();
  const double milli = known(value) ? std::clamp(value * 1e3, 0.0, kLimit) : kLimit;
  return static_cast<std::uint32_t>(std::llround(milli));
}

std::uint8_t fix_type(GpsFix fix) {
  switch (fix) {
    case GpsFix::none:
      return 0;
    case GpsFix::time_only:
      return 5;
    case GpsFix::dead_reckoning:
      return 1;
    case GpsFix::fix_2d:
      return 2;
    default:
      return 3;
  }
}

std::uint8_t fix_flags(GpsFix fix) {
  constexpr std::uint8_t kFixOk = 0x01;
  constexpr std::uint8_t kCorrected = 0x02;
  constexpr std::uint8_t kCarrierFloat = 0x40;
  constexpr std::uint8_t kCarrierFixed = 0x80;
  switch (fix) {
    case GpsFix::none:
      return 0;
    case GpsFix::differential:
      return kFixOk | kCorrected;
    case GpsFix::rtk_float:
      return kFixOk | kCorrected | kCarrierFloat;
    case GpsFix::rtk_fixed:
      return kFixOk | kCorrected | kCarrierFixed;
    default:
      return kFixOk;
  }
}

template <class T>
void append_as(std::vector<std::uint8_t>& bytes, T value, std::endian order) {
  if (order == std::endian::big) {
    append_be<T>(bytes, value);
  } else {
    append_le<T>(bytes, value);
  }
}

}  // namespace

std::vector<std::uint8_t> pvt_fields(const GpsSample& sample, TimeNs utc_ns, std::endian order,
                                     std::size_t satellites_at) {
  const CivilTime civil = to_civil(utc_ns);
  const auto& v = sample.velocity_N_m_s;
  const auto& sigma = sample.position_sigma_N_m;
  const auto& speed_sigma = sample.velocity_sigma_N_m_s;
  const double speed_m_s = std::hypot(v[0], v[1]);
  double course_deg = std::atan2(v[1], v[0]) * kDegPerRad;
  if (course_deg < 0.0) course_deg += 360.0;

  std::vector<std::uint8_t> p;
  p.reserve(96);
  const auto put = [&]<class T>(T value) { append_as<T>(p, value, order); };
  put(codec::time_of_week_ms(utc_ns));
  put(static_cast<std::uint16_t>(civil.year));
  for (const int field : {civil.month, civil.day, civil.hour, civil.minute, civil.second}) {
    p.push_back(static_cast<std::uint8_t>(field));
  }
  p.push_back(0x07);  // date and time valid, fully resolved
  put(std::uint32_t{30});
  put(static_cast<std::int32_t>(civil.nanosecond));
  p.push_back(fix_type(sample.fix));
  p.push_back(fix_flags(sample.fix));
  p.resize(24, 0);
  p[satellites_at] = static_cast<std::uint8_t>(std::clamp(sample.satellites, 0, 255));
  put(scaled(sample.longitude_rad * kDegPerRad, 1e7));
  put(scaled(sample.latitude_rad * kDegPerRad, 1e7));
  put(scaled(sample.altitude_m, 1e3));
  put(scaled(sample.altitude_msl_m, 1e3));
  put(accuracy(std::hypot(sigma[0], sigma[1])));
  put(accuracy(sigma[2]));
  for (const double component : v) put(scaled(component, 1e3));
  put(scaled(speed_m_s, 1e3));
  put(scaled(course_deg, 1e5));
  put(accuracy(std::max({speed_sigma[0], speed_sigma[1], speed_sigma[2]})));
  return p;
}

std::uint16_t pvt_dilution(double value) {
  return static_cast<std::uint16_t>(known(value) ? std::clamp(value * 100.0, 0.0, 9999.0) : 9999.0);
}

}  // namespace fathom::sim::encode
