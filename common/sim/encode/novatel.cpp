#include "sim/encode/novatel.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "base/unknown.hpp"
#include "codec/gps_time.hpp"
#include "codec/satellite/novatel/logs.hpp"
#include "codec/satellite/novatel/novatel.hpp"
#include "geo/wgs84.hpp"
#include "sim/encode/true_heading.hpp"

namespace fathom::sim::encode {
namespace {

namespace oem = codec::novatel;
using NovatelBytes = std::vector<std::uint8_t>;

oem::SolutionType solution_type(GpsFix fix) {
  switch (fix) {
    case GpsFix::none:
    case GpsFix::time_only:
      break;
    case GpsFix::dead_reckoning:
      return oem::SolutionType::propagated;
    case GpsFix::fix_2d:
      return oem::SolutionType::fixed_height;
    case GpsFix::fix_3d:
      return oem::SolutionType::single;
    case GpsFix::differential:
      return oem::SolutionType::differential;
    case GpsFix::rtk_float:
      return oem::SolutionType::narrow_float;
    case GpsFix::rtk_fixed:
      return oem::SolutionType::narrow_integer;
  }
  return oem::SolutionType::none;
}

std::uint16_t week_of(TimeNs utc_ns) {
  return static_cast<std::uint16_t>(codec::gps_of_utc(utc_ns) / codec::kGpsWeek_ns);
}

void put_novatel_crc(NovatelBytes& frame) {
  append_le<std::uint32_t>(frame, oem::crc32(frame));
}

/// Solution status and type.
void put_solution(NovatelBytes& data, oem::SolutionType type) {
  const bool solved = type != oem::SolutionType::none;
  append_le<std::uint32_t>(data, solved ? oem::kSolutionComputed : oem::kInsufficientObservations);
  append_le<std::uint32_t>(data, static_cast<std::uint32_t>(type));
}

void put_single(NovatelBytes& data, double value) {
  append_le<float>(data, known(value) ? static_cast<float>(value) : 0.0F);
}

void put_double(NovatelBytes& data, double value) {
  append_le<double>(data, known(value) ? value : 0.0);
}

}  // namespace

NovatelBytes novatel_log(std::uint16_t message, TimeNs utc_ns, std::span<const std::uint8_t> data,
                         const NovatelHeader& header) {
  constexpr std::uint8_t kCom1 = 0x20;
  constexpr std::uint8_t kHalfIdle = 100;
  NovatelBytes out{oem::kSync1, oem::kSync2, oem::kSync3, oem::kHeader};
  append_le<std::uint16_t>(out, message);
  out.push_back(header.message_type);
  out.push_back(kCom1);
  append_le<std::uint16_t>(out, static_cast<std::uint16_t>(data.size()));
  append_le<std::uint16_t>(out, 0);  // sequence
  out.push_back(kHalfIdle);
  out.push_back(header.time_status);
  append_le<std::uint16_t>(out, week_of(utc_ns));
  append_le<std::uint32_t>(out, codec::time_of_week_ms(utc_ns));
  out.resize(oem::kHeader, 0);  // status of the receiver and its software
  out.insert(out.end(), data.begin(), data.end());
  put_novatel_crc(out);
  return out;
}

NovatelBytes novatel_short_log(std::uint16_t message, TimeNs utc_ns, std::span<const std::uint8_t> data) {
  assert(data.size() <= 0xFF);
  NovatelBytes out{oem::kSync1, oem::kSync2, oem::kShortSync3, static_cast<std::uint8_t>(data.size())};
  append_le<std::uint16_t>(out, message);
  append_le<std::uint16_t>(out, week_of(utc_ns));
  append_le<std::uint32_t>(out, codec::time_of_week_ms(utc_ns));
  out.insert(out.end(), data.begin(), data.end());
  put_novatel_crc(out);
  return out;
}

NovatelBytes novatel_position(const GpsSample& s, TimeNs utc_ns, const NovatelHeader& header) {
  NovatelBytes data;
  put_solution(data, solution_type(s.fix));
  put_double(data, s.latitude_rad * kDegPerRad);
  put_double(data, s.longitude_rad * kDegPerRad);
  put_double(data, s.altitude_msl_m);
  put_single(data, s.altitude_m - s.altitude_msl_m);
  append_le<std::uint32_t>(data, oem::kDatumWgs84);
  for (const double sigma_m : s.position_sigma_N_m) put_single(data, sigma_m);
  append_le<std::uint32_t>(data, 0);  // name of the base station
  append_le<float>(data, 0.0F);       // age of its corrections
  append_le<float>(data, 0.0F);       // of the solution
  const auto satellites = static_cast<std::uint8_t>(std::clamp(s.satellites, 0, 255));
  data.insert(data.end(), {satellites, satellites, satellites, 0, 0, 0, 0, 0x01});
  return novatel_log(oem::best_position, utc_ns, data, header);
}

NovatelBytes novatel_velocity(const GpsSample& s, TimeNs utc_ns, const NovatelHeader& header) {
  const auto& v_m_s = s.velocity_N_m_s;
  NovatelBytes data;
  put_solution(data, known(v_m_s[0]) ? oem::SolutionType::doppler_velocity : oem::SolutionType::none);
  append_le<float>(data, 0.0F);  // latency
  append_le<float>(data, 0.0F);  // age of corrections
  put_double(data, std::hypot(v_m_s[0], v_m_s[1]));
  put_double(data, geo::wrap_two_pi(std::atan2(v_m_s[1], v_m_s[0])) * kDegPerRad);
  put_double(data, -v_m_s[2]);
  append_le<float>(data, 0.0F);
  return novatel_log(oem::best_velocity, utc_ns, data, header);
}

NovatelBytes novatel_time(TimeNs utc_ns) {
  const CivilTime civil = to_civil(utc_ns);
  NovatelBytes data;
  append_le<std::uint32_t>(data, 0);  // the clock is valid
  append_le<double>(data, 0.0);       // its offset to GPS time
  append_le<double>(data, 1e-9);      // and the sigma of that
  append_le<double>(data, -to_seconds(codec::kGpsAheadOfUtc_ns));
  append_le<std::uint32_t>(data, static_cast<std::uint32_t>(civil.year));
  for (const int part : {civil.month, civil.day, civil.hour, civil.minute})
    data.push_back(static_cast<std::uint8_t>(part));
  append_le<std::uint32_t>(data,
                           static_cast<std::uint32_t>(civil.second * 1000 + civil.nanosecond / 1'000'000));
  append_le<std::uint32_t>(data, 1);  // UTC is valid
  return novatel_log(oem::time_of_receiver, utc_ns, data);
}

NovatelBytes novatel_heading(const HeadingSample& s, TimeNs utc_ns, NovatelHeadingLog log) {
  constexpr std::uint32_t kNoName = 0;
  const double heading_rad = true_heading_rad(s);
  NovatelBytes data;
  put_solution(data, known(heading_rad) ? oem::SolutionType::narrow_integer : oem::SolutionType::none);
  append_le<float>(data, 1.0F);  // length of the line
  put_single(data, heading_rad * kDegPerRad);
  append_le<float>(data, 0.0F);  // pitch
  append_le<float>(data, 0.0F);
  put_single(data, s.sigma_rad * kDegPerRad);
  put_single(data, 2.0 * s.sigma_rad * kDegPerRad);  // of the pitch
  append_le<std::uint32_t>(data, kNoName);
  if (log == NovatelHeadingLog::heading2) append_le<std::uint32_t>(data, kNoName);
  data.insert(data.end(), {20, 18, 18, 16, 0x04, 0x01, 0, 0x33});
  return novatel_log(static_cast<std::uint16_t>(log), utc_ns, data);
}

NovatelBytes novatel_epoch(const GpsSample& s, TimeNs utc_ns) {
  NovatelBytes out = novatel_velocity(s, utc_ns);
  const NovatelBytes position = novatel_position(s, utc_ns);
  out.insert(out.end(), position.begin(), position.end());
  return out;
}

}  // namespace fathom::sim::encode
