#include "codec/satellite/sbf/blocks.hpp"

#include <cmath>
#include <numbers>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/gps_time.hpp"
#include "codec/satellite/receiver_numbers.hpp"
#include "codec/satellite/sbf/sbf.hpp"

namespace fathom::codec::sbf {

namespace {

// Blocks only grow at their end.
constexpr std::size_t kInstantLength = 14;
constexpr std::size_t kPvtLength = 85;
constexpr std::size_t kPvtLengthRevision2 = 94;
constexpr std::size_t kCovarianceLength = 56;
constexpr std::size_t kAttEulerLength = 44;
constexpr std::size_t kAttCovarianceLength = 40;
constexpr std::size_t kReceiverTimeLength = 22;

constexpr std::size_t kModeAt = 14;
constexpr std::size_t kErrorAt = 15;
constexpr std::uint8_t kFirstUserDatum = 250;
constexpr DurationNs kLatencyUnit_ns = 100'000;
constexpr double kAccuracyUnit_m = 0.01;

template <class Number>
double take_used(NumberCheck& check, Bytes block, std::size_t at, double least, double most) {
  const double value = load_le<Number>(block, at);
  return check.take(value != kDoNotUse, value, least, most);
}

/// From a variance; 0 is none.
double take_sigma(NumberCheck& check, Bytes block, std::size_t at) {
  const double variance = take_used<float>(check, block, at, 0.0, kMostAccuracy * kMostAccuracy);
  return variance == 0.0 ? kUnknown : std::sqrt(variance);
}

bool is_of_moving_base(Solution solution) {
  return solution == Solution::moving_base_fixed || solution == Solution::moving_base_float;
}

bool is_solution(unsigned mode) {
  const unsigned type = mode & 0xFU;
  return type <= static_cast<unsigned>(Solution::moving_base_float) ||
         type == static_cast<unsigned>(Solution::ppp);
}

Solution solution_of_mode(unsigned mode) {
  return static_cast<Solution>(mode & 0xFU);
}

GpsFix fix_of_mode(unsigned mode) {
  const Solution solution = solution_of_mode(mode);
  if (solution == Solution::none) return GpsFix::none;
  if (solution == Solution::told) return GpsFix::dead_reckoning;
  if ((mode & kTwoDimensional) != 0) return GpsFix::fix_2d;
  if (solution == Solution::single) return GpsFix::fix_3d;
  if (solution == Solution::rtk_fixed) return GpsFix::rtk_fixed;
  if (solution == Solution::rtk_float) return GpsFix::rtk_float;
  return GpsFix::differential;
}

/// All others are within a few metres of WGS 84.
bool is_defined_by_user(std::uint8_t datum) {
  return datum >= kFirstUserDatum && datum != kDoNotUse8;
}

/// What the receiver says of the test of its integrity.
bool is_disowned(unsigned alert) {
  constexpr unsigned kRaimFailed = 2;
  constexpr unsigned kGalileoFailed = 1U << 2U;
  return (alert & 3U) == kRaimFailed || (alert & kGalileoFailed) != 0;
}

void read_accuracies(Bytes block, GpsSample& s) {
  const auto horizontal = load_le<std::uint16_t>(block, 90);
  const auto vertical = load_le<std::uint16_t>(block, 92);
  // 0 is below the resolution and says nothing.
  if (horizontal != kDoNotUse16 && horizontal != 0) {
    const double axis_m = horizontal * kAccuracyUnit_m / (2.0 * std::numbers::sqrt2);
    s.position_sigma_N_m[0] = s.position_sigma_N_m[1] = axis_m;
  }
  if (vertical != kDoNotUse16 && vertical != 0 && s.fix != GpsFix::fix_2d)
    s.position_sigma_N_m[2] = vertical * kAccuracyUnit_m / 2.0;
}

}  // namespace

std::optional<RejectReason> read_instant(Bytes block, GpsInstant& into) {
  if (block.size() < kInstantLength) return RejectReason::length;
  const auto time_of_week_ms = load_le<std::uint32_t>(block, 8);
  const auto week = load_le<std::uint16_t>(block, 12);
  if (time_of_week_ms == kDoNotUse32 || week == kDoNotUse16) return std::nullopt;
  into = gps_of_week(week, time_of_week_ms);
  return into ? std::nullopt : std::optional(RejectReason::out_of_range);
}

std::optional<RejectReason> read_pvt(Bytes block, unsigned revision, Pvt& into) {
  const bool has_accuracies = revision >= 2;
  if (block.size() < (has_accuracies ? kPvtLengthRevision2 : kPvtLength)) return RejectReason::length;
  GpsSample& s = into.sample;
  const unsigned mode = block[kModeAt];
  if (!is_solution(mode)) return RejectReason::field;
  if (block[74] != kDoNotUse8) s.satellites = block[74];
  if (has_accuracies) {
    const auto latency = load_le<std::uint16_t>(block, 88);
    if (latency != kDoNotUse16) into.age_ns = latency * kLatencyUnit_ns;
  }
  if (block[kErrorAt] == 0 && !is_disowned(block[84])) s.fix = fix_of_mode(mode);
  if (s.fix == GpsFix::none) return std::nullopt;
  if (is_defined_by_user(block[73])) return RejectReason::field;
  constexpr double kHalfTurn_rad = std::numbers::pi;
  NumberCheck check;
  s.latitude_rad = take_used<double>(check, block, 16, -kHalfTurn_rad / 2.0, kHalfTurn_rad / 2.0);
  s.longitude_rad = take_used<double>(check, block, 24, -kHalfTurn_rad, kHalfTurn_rad);
  if (!check.reason() && (!known(s.latitude_rad) || !known(s.longitude_rad))) return RejectReason::incomplete;
  const double height_m = take_used<double>(check, block, 32, -kMostHeight_m, kMostHeight_m);
  const double undulation_m = take_used<float>(check, block, 40, -kMostHeight_m, kMostHeight_m);
  if (s.fix != GpsFix::fix_2d) {
    s.altitude_m = height_m;
    s.altitude_msl_m = height_m - undulation_m;
  }
  for (std::size_t i = 0; i < 3; ++i)
    s.velocity_N_m_s[i] = take_used<float>(check, block, 44 + 4 * i, -kMostVelocity_m_s, kMostVelocity_m_s);
  s.velocity_N_m_s[2] = 0.0 - s.velocity_N_m_s[2];  // said upwards; 0 stays without sign
  s.course_rad = heading_of(take_used<float>(check, block, 56, 0.0, 360.0));
  if (has_accuracies && !is_of_moving_base(solution_of_mode(mode))) read_accuracies(block, s);
  return check.reason();
}

namespace {

std::optional<RejectReason> read_covariance(Bytes block, Sigmas& into) {
  if (block.size() < kCovarianceLength) return RejectReason::length;
  if (!is_solution(block[kModeAt])) return RejectReason::field;
  if (solution_of_mode(block[kModeAt]) == Solution::none || block[kErrorAt] != 0) return std::nullopt;
  NumberCheck check;
  for (std::size_t i = 0; i < 3; ++i) into[i] = take_sigma(check, block, 16 + 4 * i);
  return check.reason();
}

}  // namespace

std::optional<RejectReason> read_position_covariance(Bytes block, Sigmas& sigma_m) {
  sigma_m.fill(kUnknown);
  const auto reason = read_covariance(block, sigma_m);
  if (!reason && is_of_moving_base(solution_of_mode(block[kModeAt]))) sigma_m.fill(kUnknown);
  return reason;
}

std::optional<RejectReason> read_velocity_covariance(Bytes block, Sigmas& sigma_m_s) {
  sigma_m_s.fill(kUnknown);
  return read_covariance(block, sigma_m_s);
}

std::optional<RejectReason> read_att_euler(Bytes block, HeadingSample& into) {
  constexpr unsigned kNotRequested = 1U << 7U;
  constexpr unsigned kFirstBaseline = 3;
  if (block.size() < kAttEulerLength) return RejectReason::length;
  const unsigned error = block[15];
  const auto mode = load_le<std::uint16_t>(block, 16);
  if (mode > kFullAttitudeFixed) return RejectReason::field;
  if (mode != kAttitudeFixed && mode != kFullAttitudeFixed) return std::nullopt;
  if ((error & (kNotRequested | kFirstBaseline)) != 0) return std::nullopt;
  NumberCheck check;
  into.heading_rad = heading_of(take_used<float>(check, block, 20, 0.0, 360.0));
  return check.reason();
}

std::optional<RejectReason> read_att_covariance(Bytes block, double& heading_sigma_rad) {
  if (block.size() < kAttCovarianceLength) return RejectReason::length;
  NumberCheck check;
  heading_sigma_rad = kRadPerDeg * take_sigma(check, block, 16);
  return check.reason();
}

std::optional<RejectReason> read_leap_seconds(Bytes block, DurationNs& ahead_of_utc_ns) {
  constexpr int kMostLeapSeconds = 60;
  if (block.size() < kReceiverTimeLength) return RejectReason::length;
  const auto seconds = load_le<std::int8_t>(block, 20);
  if (seconds == kDoNotUseSigned) return std::nullopt;
  if (seconds < 0 || seconds > kMostLeapSeconds) return RejectReason::out_of_range;
  ahead_of_utc_ns = seconds * kNsPerSecond;
  return std::nullopt;
}

}  // namespace fathom::codec::sbf
