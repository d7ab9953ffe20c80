#include "codec/imu/sbg_gnss.hpp"

#include <cmath>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/gps_time.hpp"
#include "codec/satellite/receiver_numbers.hpp"

namespace fathom::codec::sbg {

namespace {

// Logs only grow at their end: the number of satellites, and later the state of interference, came on.
constexpr std::size_t kVelocityData = 44;
constexpr std::size_t kPositionData = 52;
constexpr std::size_t kHeadingData = 26;  // before the length of the line between the antennas
constexpr std::size_t kSatellitesAt = 52;
constexpr std::size_t kInterferenceAt = 58;
constexpr std::uint8_t kNoCount = 0xFF;
constexpr std::uint32_t kWeek_ms = kGpsWeek_ns / kNsPerMillisecond;

unsigned solution_of(std::uint32_t status) {
  return status & 0x3FU;
}
unsigned type_of(std::uint32_t status) {
  return status >> 6U & 0x3FU;
}

GpsFix fix_of_position(PositionType type) {
  switch (type) {
    case PositionType::told:
      return GpsFix::dead_reckoning;
    case PositionType::single:
      return GpsFix::fix_3d;
    case PositionType::differential:
    case PositionType::sbas:
    case PositionType::omnistar:
    case PositionType::ppp_float:
    case PositionType::ppp_fixed:
      return GpsFix::differential;
    case PositionType::rtk_float:
      return GpsFix::rtk_float;
    case PositionType::rtk_fixed:
      return GpsFix::rtk_fixed;
    case PositionType::none:
    case PositionType::unknown:
      break;
  }
  return GpsFix::none;
}

GpsJamming jamming_of(unsigned word) {
  constexpr std::array<GpsJamming, 5> kMeaning{GpsJamming::unknown, GpsJamming::unknown, GpsJamming::none,
                                               GpsJamming::warning, GpsJamming::critical};
  return word < kMeaning.size() ? kMeaning[word] : GpsJamming::unknown;
}

GpsSpoofing spoofing_of(unsigned word) {
  constexpr std::array<GpsSpoofing, 5> kMeaning{GpsSpoofing::unknown, GpsSpoofing::unknown, GpsSpoofing::none,
                                                GpsSpoofing::indicated, GpsSpoofing::affirmed};
  return word < kMeaning.size() ? kMeaning[word] : GpsSpoofing::unknown;
}

}  // namespace

std::optional<RejectReason> read_position(Bytes data, Position& into) {
  if (data.size() < kPositionData) return RejectReason::length;
  GpsSample& s = into.sample;
  into.stamp_us = load_le<std::uint32_t>(data, 0);
  const auto status = load_le<std::uint32_t>(data, 4);
  into.time_of_week_ms = load_le<std::uint32_t>(data, 8);
  if (data.size() > kSatellitesAt && data[kSatellitesAt] != kNoCount) s.satellites = data[kSatellitesAt];
  if (data.size() >= kInterferenceAt + 4) {
    const auto state = load_le<std::uint32_t>(data, kInterferenceAt);
    s.jamming = jamming_of(state & 0xFU);
    s.spoofing = spoofing_of(state >> 4U & 0xFU);
  }
  if (solution_of(status) != kSolutionComputed) return std::nullopt;
  if (type_of(status) > static_cast<unsigned>(PositionType::told)) return RejectReason::field;
  s.fix = fix_of_position(static_cast<PositionType>(type_of(status)));
  if (s.fix == GpsFix::none) return std::nullopt;
  if (into.time_of_week_ms >= kWeek_ms) return RejectReason::out_of_range;
  NumberCheck check;
  s.latitude_rad = kRadPerDeg * check.take(true, load_le<double>(data, 12), -90.0, 90.0);
  s.longitude_rad = kRadPerDeg * check.take(true, load_le<double>(data, 20), -180.0, 180.0);
  s.altitude_msl_m = check.take(true, load_le<double>(data, 28), -kMostHeight_m, kMostHeight_m);
  const double undulation_m = check.take(true, load_le<float>(data, 36), -kMostHeight_m, kMostHeight_m);
  s.altitude_m = s.altitude_msl_m + undulation_m;
  for (std::size_t i = 0; i < 3; ++i)
    s.position_sigma_N_m[i] = check.take_sigma(true, load_le<float>(data, 40 + 4 * i));
  return check.reason();
}

std::optional<RejectReason> read_velocity(Bytes data, EpochVelocity& into) {
  if (data.size() < kVelocityData) return RejectReason::length;
  const auto status = load_le<std::uint32_t>(data, 4);
  into.time_of_week_ms = load_le<std::uint32_t>(data, 8);
  if (solution_of(status) != kSolutionComputed) return std::nullopt;
  if (type_of(status) > static_cast<unsigned>(VelocityType::differential)) return RejectReason::field;
  if (type_of(status) < static_cast<unsigned>(VelocityType::doppler)) return std::nullopt;
  NumberCheck check;
  for (std::size_t i = 0; i < 3; ++i) {
    into.velocity_N_m_s[i] =
        check.take(true, load_le<float>(data, 12 + 4 * i), -kMostVelocity_m_s, kMostVelocity_m_s);
    into.sigma_N_m_s[i] = check.take_sigma(true, load_le<float>(data, 24 + 4 * i));
  }
  const auto course_deg = load_le<float>(data, 36);  // standing still there may be none
  into.course_rad = as_course(kRadPerDeg * check.take(std::isfinite(course_deg), course_deg, -360.0, 360.0));
  return check.reason();
}

std::optional<RejectReason> read_heading(Bytes data, Heading& into) {
  if (data.size() < kHeadingData) return RejectReason::length;
  into.stamp_us = load_le<std::uint32_t>(data, 0);
  const auto status = load_le<std::uint16_t>(data, 4);
  into.time_of_week_ms = load_le<std::uint32_t>(data, 6);
  const double sigma_deg = load_le<float>(data, 14);
  if (solution_of(status) != kSolutionComputed || sigma_deg >= kNoHeading_deg) return std::nullopt;
  if (into.time_of_week_ms >= kWeek_ms) return RejectReason::out_of_range;
  NumberCheck check;
  const double heading_deg = check.take(true, load_le<float>(data, 10), 0.0, 360.0);
  into.sample.heading_rad = heading_of(heading_deg);
  if (sigma_deg > 0.0) into.sample.sigma_rad = kRadPerDeg * sigma_deg;
  return check.reason();
}

}  // namespace fathom::codec::sbg
