#include "sim/encode/sbf.hpp"

#include <algorithm>
#include <cmath>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/crc16.hpp"
#include "codec/gps_time.hpp"
#include "codec/satellite/sbf/sbf.hpp"
#include "sim/encode/true_heading.hpp"

namespace fathom::sim::encode {
namespace {

using codec::sbf::Solution;

constexpr std::uint8_t kSbfNoError = 0;
constexpr std::uint8_t kSbfNotEnoughMeasurements = 1;
constexpr std::size_t kSbfCovariances = 10;  // upper triangle of position or velocity and the clock

double or_do_not_use(double value) {
  return known(value) ? value : codec::sbf::kDoNotUse;
}
void append_real(std::vector<std::uint8_t>& body, double value) {
  append_le<double>(body, or_do_not_use(value));
}
void append_single(std::vector<std::uint8_t>& body, double value) {
  append_le<float>(body, static_cast<float>(or_do_not_use(value)));
}

/// In centimetres; at most what the field holds.
std::uint16_t accuracy_cm(double accuracy_m) {
  if (!known(accuracy_m)) return codec::sbf::kDoNotUse16;
  return static_cast<std::uint16_t>(std::clamp(std::round(accuracy_m * 100.0), 0.0, 65'534.0));
}

unsigned pvt_mode_of(GpsFix fix) {
  switch (fix) {
    case GpsFix::dead_reckoning:
      return static_cast<unsigned>(Solution::told);
    case GpsFix::fix_2d:
      return static_cast<unsigned>(Solution::single) | codec::sbf::kTwoDimensional;
    case GpsFix::fix_3d:
      return static_cast<unsigned>(Solution::single);
    case GpsFix::differential:
      return static_cast<unsigned>(Solution::differential);
    case GpsFix::rtk_float:
      return static_cast<unsigned>(Solution::rtk_float);
    case GpsFix::rtk_fixed:
      return static_cast<unsigned>(Solution::rtk_fixed);
    case GpsFix::none:
    case GpsFix::time_only:
      break;
  }
  return static_cast<unsigned>(Solution::none);
}

/// Mode and error.
std::vector<std::uint8_t> solution_body(GpsFix fix) {
  const unsigned mode = pvt_mode_of(fix);
  return {static_cast<std::uint8_t>(mode), mode == 0 ? kSbfNotEnoughMeasurements : kSbfNoError};
}

std::vector<std::uint8_t> covariance_body(GpsFix fix, const std::array<double, 3>& sigma) {
  std::vector<std::uint8_t> body = solution_body(fix);
  for (const double one : sigma) append_single(body, one * one);
  for (std::size_t i = sigma.size(); i < kSbfCovariances; ++i) append_single(body, kUnknown);
  return body;
}

}  // namespace

std::vector<std::uint8_t> sbf_block(std::uint16_t number, unsigned revision, TimeNs utc_ns,
                                    std::span<const std::uint8_t> body) {
  const DurationNs week = codec::gps_of_utc(utc_ns) / codec::kGpsWeek_ns;
  std::vector<std::uint8_t> block{codec::sbf::kSync1, codec::sbf::kSync2, 0, 0};
  append_le<std::uint16_t>(block, static_cast<std::uint16_t>(number | revision << 13U));
  append_le<std::uint16_t>(block, 0);
  append_le<std::uint32_t>(block, codec::time_of_week_ms(utc_ns));
  append_le<std::uint16_t>(block, static_cast<std::uint16_t>(week));
  block.insert(block.end(), body.begin(), body.end());
  block.resize((block.size() + 3) / 4 * 4, 0);
  store_le<std::uint16_t>(block, 6, static_cast<std::uint16_t>(block.size()));
  store_le<std::uint16_t>(block, 2, codec::crc16_ccitt(std::span(block).subspan(codec::sbf::kSummedFrom)));
  return block;
}

std::vector<std::uint8_t> sbf_pvt_geodetic(const GpsSample& sample, TimeNs utc_ns) {
  const bool located = sample.fix >= GpsFix::dead_reckoning;
  const auto if_located = [&](double value) { return located ? value : kUnknown; };
  std::vector<std::uint8_t> body = solution_body(sample.fix);
  for (const double value : {sample.latitude_rad, sample.longitude_rad, sample.altitude_m})
    append_real(body, if_located(value));
  append_single(body, if_located(sample.altitude_m - sample.altitude_msl_m));
  for (const double value : {sample.velocity_N_m_s[0], sample.velocity_N_m_s[1], -sample.velocity_N_m_s[2],
                             sample.course_rad * kDegPerRad})
    append_single(body, if_located(value));
  append_real(body, kUnknown);    // bias of the clock
  append_single(body, kUnknown);  // and its drift
  body.push_back(0);              // of GPS time
  body.push_back(0);              // in WGS 84
  const bool counted = sample.satellites >= 0 && sample.satellites < codec::sbf::kDoNotUse8;
  body.push_back(counted ? static_cast<std::uint8_t>(sample.satellites) : codec::sbf::kDoNotUse8);
  body.push_back(0);                                        // wide-area corrections
  append_le<std::uint16_t>(body, codec::sbf::kDoNotUse16);  // reference station
  append_le<std::uint16_t>(body, codec::sbf::kDoNotUse16);  // age of the corrections
  append_le<std::uint32_t>(body, 0);                        // signals
  body.insert(body.end(), {0, 0, 0, 0});                    // alert flag, bases, precise point position
  append_le<std::uint16_t>(body, codec::sbf::kDoNotUse16);  // latency
  const auto& sigma = sample.position_sigma_N_m;
  append_le<std::uint16_t>(body, accuracy_cm(if_located(2.0 * std::hypot(sigma[0], sigma[1]))));
  append_le<std::uint16_t>(body, accuracy_cm(if_located(2.0 * sigma[2])));
  body.push_back(0);
  return sbf_block(codec::sbf::pvt_geodetic, 2, utc_ns, body);
}

std::vector<std::uint8_t> sbf_position_covariance(const GpsSample& sample, TimeNs utc_ns) {
  return sbf_block(codec::sbf::position_covariance, 0, utc_ns,
                   covariance_body(sample.fix, sample.position_sigma_N_m));
}

std::vector<std::uint8_t> sbf_velocity_covariance(const GpsSample& sample, TimeNs utc_ns) {
  return sbf_block(codec::sbf::velocity_covariance, 0, utc_ns,
                   covariance_body(sample.fix, sample.velocity_sigma_N_m_s));
}

std::vector<std::uint8_t> sbf_att_euler(const HeadingSample& sample, TimeNs utc_ns) {
  const double heading_rad = true_heading_rad(sample);
  const bool known_heading = known(heading_rad);
  std::vector<std::uint8_t> body{codec::sbf::kDoNotUse8,
                                 known_heading ? kSbfNoError : kSbfNotEnoughMeasurements};
  append_le<std::uint16_t>(body, known_heading ? codec::sbf::kAttitudeFixed : 0);
  append_le<std::uint16_t>(body, 0);
  append_single(body, heading_rad * kDegPerRad);
  for (int i = 0; i < 5; ++i) append_single(body, kUnknown);  // pitch, roll and the rates
  return sbf_block(codec::sbf::att_euler, 0, utc_ns, body);
}

std::vector<std::uint8_t> sbf_att_covariance(const HeadingSample& sample, TimeNs utc_ns) {
  const double sigma_deg = sample.sigma_rad * kDegPerRad;
  std::vector<std::uint8_t> body{0, kSbfNoError};
  append_single(body, sigma_deg * sigma_deg);
  for (int i = 0; i < 5; ++i) append_single(body, kUnknown);
  return sbf_block(codec::sbf::att_covariance, 0, utc_ns, body);
}

std::vector<std::uint8_t> sbf_receiver_time(TimeNs utc_ns, std::int8_t leap_seconds) {
  constexpr std::uint8_t kSynchronized = 7;
  const CivilTime civil = to_civil(utc_ns);
  std::vector<std::uint8_t> body;
  for (const int value : {civil.year % 100, civil.month, civil.day, civil.hour, civil.minute, civil.second})
    body.push_back(static_cast<std::uint8_t>(value));
  append_le<std::int8_t>(body, leap_seconds);
  body.push_back(kSynchronized);
  return sbf_block(codec::sbf::receiver_time, 0, utc_ns, body);
}

std::vector<std::uint8_t> sbf_end_of_pvt(TimeNs utc_ns) {
  return sbf_block(codec::sbf::end_of_pvt, 0, utc_ns, {});
}

std::vector<std::uint8_t> sbf_end_of_att(TimeNs utc_ns) {
  return sbf_block(codec::sbf::end_of_att, 0, utc_ns, {});
}

std::vector<std::uint8_t> sbf_epoch(const GpsSample& sample, TimeNs utc_ns) {
  std::vector<std::uint8_t> out = sbf_pvt_geodetic(sample, utc_ns);
  for (const auto& block : {sbf_position_covariance(sample, utc_ns), sbf_velocity_covariance(sample, utc_ns),
                            sbf_end_of_pvt(utc_ns)})
    out.insert(out.end(), block.begin(), block.end());
  return out;
}

std::vector<std::uint8_t> sbf_attitude_epoch(const HeadingSample& sample, TimeNs utc_ns) {
  std::vector<std::uint8_t> out = sbf_att_euler(sample, utc_ns);
  for (const auto& block : {sbf_att_covariance(sample, utc_ns), sbf_end_of_att(utc_ns)})
    out.insert(out.end(), block.begin(), block.end());
  return out;
}

}  // namespace fathom::sim::encode
