#include "sim/encode/imu/sbg.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/gps_time.hpp"
#include "codec/imu/sbg.hpp"
#include "codec/imu/sbg_gnss.hpp"
#include "geo/wgs84.hpp"
#include "sim/encode/decimal.hpp"
#include "sim/encode/true_heading.hpp"

namespace fathom::sim::encode {
namespace {

namespace ecom = codec::sbg;
using Frame = std::vector<std::uint8_t>;

constexpr std::uint8_t kLogs = 0;

void put_stamp(Frame& data, DurationNs since_startup_ns) {
  assert(since_startup_ns >= 0);
  append_le<std::uint32_t>(data, static_cast<std::uint32_t>(since_startup_ns / 1'000));
}

/// Of a triad's axes those that are known.
unsigned known_axes(const std::array<double, 3>& values, unsigned first_axis) {
  unsigned bits = 0;
  for (unsigned i = 0; i < 3; ++i) {
    if (known(values[i])) bits |= first_axis << i;
  }
  return bits;
}

unsigned status_of(const ImuSample& s) {
  return ecom::link | ecom::self_test | ecom::accelerometers_in_range | ecom::gyros_in_range |
         known_axes(s.specific_force_B_m_s2, ecom::accelerometer_x) |
         known_axes(s.angular_rate_B_rad_s, ecom::gyro_x);
}

ecom::PositionType position_type(GpsFix fix) {
  switch (fix) {
    case GpsFix::none:
    case GpsFix::time_only:
      break;
    case GpsFix::dead_reckoning:
      return ecom::PositionType::told;
    case GpsFix::fix_2d:
    case GpsFix::fix_3d:
      return ecom::PositionType::single;
    case GpsFix::differential:
      return ecom::PositionType::differential;
    case GpsFix::rtk_float:
      return ecom::PositionType::rtk_float;
    case GpsFix::rtk_fixed:
      return ecom::PositionType::rtk_fixed;
  }
  return ecom::PositionType::none;
}

/// Stamp, status and time of the week of a receiver's log.
void put_gps_head(Frame& data, bool solved, unsigned type, TimeNs utc_ns, DurationNs since_startup_ns) {
  put_stamp(data, since_startup_ns);
  append_le<std::uint32_t>(data, (solved ? ecom::kSolutionComputed : ecom::kInsufficientObservations) |
                                     (solved ? type << 6U : 0U));
  append_le<std::uint32_t>(data, codec::time_of_week_ms(utc_ns));
}

template <class Count>
void put_counts(Frame& data, double counts) {
  constexpr double kLow = std::numeric_limits<Count>::min();
  constexpr double kHigh = std::numeric_limits<Count>::max();
  append_le<Count>(data, static_cast<Count>(std::clamp(std::round(zero_if_unknown(counts)), kLow, kHigh)));
}

}  // namespace

Frame sbg_frame(std::uint8_t message, std::uint8_t message_class, const Frame& data) {
  assert(data.size() <= ecom::kMostData);
  Frame out{ecom::kSync1, ecom::kSync2, message, message_class};
  append_le<std::uint16_t>(out, static_cast<std::uint16_t>(data.size()));
  out.insert(out.end(), data.begin(), data.end());
  append_le<std::uint16_t>(out, ecom::crc16(std::span(out).subspan(2)));
  out.push_back(ecom::kEnd);
  return out;
}

Frame sbg_imu_short(const ImuSample& s, DurationNs since_startup_ns) {
  constexpr double kMostFine_rad_s = 31.9;
  const bool fast = std::any_of(s.angular_rate_B_rad_s.begin(), s.angular_rate_B_rad_s.end(),
                                [](double rate) { return std::abs(rate) > kMostFine_rad_s; });
  Frame data;
  put_stamp(data, since_startup_ns);
  unsigned status = status_of(s);
  if (fast) status |= ecom::high_rate_scale;
  append_le<std::uint16_t>(data, static_cast<std::uint16_t>(status));
  for (const double force : s.specific_force_B_m_s2)
    put_counts<std::int32_t>(data, force * ecom::kForceCounts);
  for (const double rate : s.angular_rate_B_rad_s)
    put_counts<std::int32_t>(data, rate * (fast ? ecom::kHighRateCounts : ecom::kRateCounts));
  put_counts<std::int16_t>(data, s.temperature_degC * ecom::kTemperatureCounts);
  return sbg_frame(ecom::imu_short, kLogs, data);
}

Frame sbg_imu_data(const ImuSample& s, DurationNs since_startup_ns) {
  Frame data;
  put_stamp(data, since_startup_ns);
  append_le<std::uint16_t>(data, static_cast<std::uint16_t>(status_of(s)));
  const auto put3 = [&](const std::array<double, 3>& values) {
    for (const double value : values) append_le<float>(data, static_cast<float>(zero_if_unknown(value)));
  };
  put3(s.specific_force_B_m_s2);
  put3(s.angular_rate_B_rad_s);
  append_le<float>(data, static_cast<float>(zero_if_unknown(s.temperature_degC)));
  put3(s.specific_force_B_m_s2);
  put3(s.angular_rate_B_rad_s);
  return sbg_frame(ecom::imu_data, kLogs, data);
}

Frame sbg_utc_time(TimeNs utc_ns, DurationNs since_startup_ns) {
  const CivilTime civil = to_civil(utc_ns);
  Frame data;
  put_stamp(data, since_startup_ns);
  append_le<std::uint16_t>(data, static_cast<std::uint16_t>(1U | ecom::kClockValid << 1U | 1U << 5U |
                                                            ecom::kUtcInitialized << 6U));
  append_le<std::uint16_t>(data, static_cast<std::uint16_t>(civil.year));
  for (const int part : {civil.month, civil.day, civil.hour, civil.minute, civil.second})
    data.push_back(static_cast<std::uint8_t>(part));
  append_le<std::int32_t>(data, civil.nanosecond);
  append_le<std::uint32_t>(data, codec::time_of_week_ms(utc_ns));
  for (int i = 0; i < 3; ++i) append_le<float>(data, 0.0F);
  return sbg_frame(ecom::utc_time, kLogs, data);
}

Frame sbg_gps_position(const GpsSample& s, TimeNs utc_ns, DurationNs since_startup_ns, int receiver) {
  const ecom::PositionType type = position_type(s.fix);
  Frame data;
  put_gps_head(data, type != ecom::PositionType::none, static_cast<unsigned>(type), utc_ns, since_startup_ns);
  append_le<double>(data, zero_if_unknown(s.latitude_rad * kDegPerRad));
  append_le<double>(data, zero_if_unknown(s.longitude_rad * kDegPerRad));
  append_le<double>(data, zero_if_unknown(s.altitude_msl_m));
  append_le<float>(data, static_cast<float>(zero_if_unknown(s.altitude_m - s.altitude_msl_m)));
  for (const double sigma_m : s.position_sigma_N_m)
    append_le<float>(data, static_cast<float>(zero_if_unknown(sigma_m)));
  data.push_back(s.satellites < 0 ? 0xFF : static_cast<std::uint8_t>(std::min(s.satellites, 254)));
  append_le<std::uint16_t>(data, 0xFFFF);  // no base station
  append_le<std::uint16_t>(data, 0xFFFF);  // no age of its corrections
  data.push_back(0xFF);                    // how many satellites are tracked is not known
  const auto jamming = static_cast<std::uint32_t>(s.jamming) + 1U;
  const auto spoofing = static_cast<std::uint32_t>(s.spoofing) + 1U;
  append_le<std::uint32_t>(data, jamming | spoofing << 4U);
  return sbg_frame(receiver == 2 ? ecom::gps2_position : ecom::gps1_position, kLogs, data);
}

Frame sbg_gps_velocity(const GpsSample& s, TimeNs utc_ns, DurationNs since_startup_ns, int receiver) {
  Frame data;
  put_gps_head(data, known(s.velocity_N_m_s[0]), static_cast<unsigned>(ecom::VelocityType::doppler), utc_ns,
               since_startup_ns);
  for (const double v_m_s : s.velocity_N_m_s)
    append_le<float>(data, static_cast<float>(zero_if_unknown(v_m_s)));
  for (const double sigma_m_s : s.velocity_sigma_N_m_s)
    append_le<float>(data, static_cast<float>(zero_if_unknown(sigma_m_s)));
  append_le<float>(data, static_cast<float>(s.course_rad * kDegPerRad));
  append_le<float>(data, 0.0F);
  return sbg_frame(receiver == 2 ? ecom::gps2_velocity : ecom::gps1_velocity, kLogs, data);
}

Frame sbg_gps_heading(const HeadingSample& s, TimeNs utc_ns, DurationNs since_startup_ns, int receiver) {
  constexpr float kNoPitch_deg = 90.0F;
  const double heading_deg = true_heading_rad(s) * kDegPerRad;
  const double sigma_deg = zero_if_unknown(s.sigma_rad) * kDegPerRad;
  const bool solved = known(heading_deg);
  Frame data;
  put_stamp(data, since_startup_ns);
  const unsigned status = solved ? ecom::kSolutionComputed : ecom::kInsufficientObservations;
  append_le<std::uint16_t>(data, static_cast<std::uint16_t>(status));
  append_le<std::uint32_t>(data, codec::time_of_week_ms(utc_ns));
  append_le<float>(data, static_cast<float>(zero_if_unknown(heading_deg)));
  append_le<float>(data, static_cast<float>(solved ? sigma_deg : ecom::kNoHeading_deg));
  append_le<float>(data, 0.0F);
  append_le<float>(data, kNoPitch_deg);
  append_le<float>(data, 0.0F);  // how far the antennas are apart is not said
  data.push_back(0xFF);          // nor how many satellites are tracked,
  data.push_back(0xFF);          // nor used
  return sbg_frame(receiver == 2 ? ecom::gps2_heading : ecom::gps1_heading, kLogs, data);
}

Frame sbg_epoch(const GpsSample& s, TimeNs utc_ns, DurationNs since_startup_ns) {
  Frame out = sbg_utc_time(utc_ns, since_startup_ns);
  for (const Frame& frame :
       {sbg_gps_velocity(s, utc_ns, since_startup_ns), sbg_gps_position(s, utc_ns, since_startup_ns)})
    out.insert(out.end(), frame.begin(), frame.end());
  return out;
}

}  // namespace fathom::sim::encode
