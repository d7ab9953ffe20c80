#include "codec/satellite/novatel/logs.hpp"

#include <cmath>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/satellite/receiver_numbers.hpp"

namespace fathom::codec::novatel {
namespace {

// Messages may grow at their end.
constexpr std::size_t kPositionMessage = 72;
constexpr std::size_t kVelocityMessage = 44;
constexpr std::size_t kHeadingMessage = 44;
constexpr std::size_t kTimeMessage = 44;

constexpr std::uint32_t kFixedVelocity = 3;
constexpr double kMostLatency_s = 0.15F;
constexpr double kMostOnAVehicle_m = 500.0;
constexpr double kNoHeadingSigma_deg = 180.0;

bool is_velocity_type(std::uint32_t type) {
  return type == kFixedVelocity || type == static_cast<std::uint32_t>(SolutionType::doppler_velocity) ||
         fix_of_solution(type).has_value();
}

}  // namespace

bool is_known(TimeStatus status) {
  switch (status) {
    case TimeStatus::coarse:
    case TimeStatus::coarse_steering:
    case TimeStatus::freewheeling:
    case TimeStatus::fine_adjusting:
    case TimeStatus::fine:
    case TimeStatus::fine_backup_steering:
    case TimeStatus::fine_steering:
    case TimeStatus::exact:
      return true;
    case TimeStatus::unknown:
    case TimeStatus::approximate:
    case TimeStatus::coarse_adjusting:
    case TimeStatus::of_satellite:
    case TimeStatus::external:
      break;
  }
  return false;
}

std::optional<GpsFix> fix_of_solution(std::uint32_t type) {
  switch (type) {
    case 0:
      return GpsFix::none;
    case 1:   // FIXEDPOS: somebody has set it
    case 19:  // PROPAGATED: by a filter, without measurements
    case 67:  // EXT_CONSTRAINED
      return GpsFix::dead_reckoning;
    case 2:  // FIXEDHEIGHT
      return GpsFix::fix_2d;
    case 16:  // SINGLE
    case 53:  // INS_PSRSP
    // The receiver says whether the accuracy that its user wants is kept, and not how the solution was made.
    case 70:  // OPERATIONAL
    case 71:  // WARNING
    case 72:  // OUT_OF_BOUNDS
      return GpsFix::fix_3d;
    case 17:  // PSRDIFF
    case 18:  // WAAS: any augmentation by satellites
    case 20:  // OMNISTAR
    case 52:  // INS_SBAS
    case 54:  // INS_PSRDIFF
    case 57:  // INS_OMNISTAR, _HP, _XP
    case 58:
    case 59:
    case 64:  // OMNISTAR_HP, _XP
    case 65:
    case 66:  // CDGPS
    case 68:  // PPP_CONVERGING, PPP
    case 69:
    case 73:  // INS_PPP_CONVERGING, INS_PPP
    case 74:
    case 75:  // PPP_PLUS, INS_PPP_PLUS
    case 76:
    case 77:  // PPP_BASIC_CONVERGING, PPP_BASIC
    case 78:
    case 79:  // INS_PPP_BASIC_CONVERGING, INS_PPP_BASIC
    case 80:
      return GpsFix::differential;
    case 4:   // FLOATCONV
    case 32:  // L1_FLOAT
    case 33:  // IONOFREE_FLOAT
    case 34:  // NARROW_FLOAT
    case 35:  // L1L2_FLOAT
    case 55:  // INS_RTKFLOAT
      return GpsFix::rtk_float;
    case 5:  // WIDELANE, NARROWLANE
    case 6:
    case 46:  // L1L2_INT, and verified
    case 47:
    case 48:  // L1_INT
    case 49:  // WIDE_INT
    case 50:  // NARROW_INT
    case 51:  // RTK_DIRECT_INS
    case 56:  // INS_RTKFIXED
      return GpsFix::rtk_fixed;
    default:
      return std::nullopt;
  }
}

bool Header::is_log_of_primary() const {
  return (message_type & (kFormatMask | kResponse)) == 0 && (message_type & kSourceMask) != kSecondaryAntenna;
}

Header read_header(Bytes frame) {
  return {.message = load_le<std::uint16_t>(frame, 4),
          .message_type = frame[6],
          .time_status = static_cast<TimeStatus>(frame[13]),
          .week = load_le<std::uint16_t>(frame, 14),
          .time_of_week_ms = load_le<std::uint32_t>(frame, 16)};
}

std::optional<RejectReason> read_position(Bytes message, GpsSample& into) {
  if (message.size() < kPositionMessage) return RejectReason::length;
  into.satellites = message[65];  // in the solution
  if (load_le<std::uint32_t>(message, 0) != kSolutionComputed) return std::nullopt;
  const auto fix = fix_of_solution(load_le<std::uint32_t>(message, 4));
  if (!fix) return RejectReason::field;
  into.fix = *fix;
  if (into.fix == GpsFix::none) return std::nullopt;
  if (load_le<std::uint32_t>(message, 36) != kDatumWgs84) return RejectReason::field;
  NumberCheck check;
  into.latitude_rad = kRadPerDeg * check.take(true, load_le<double>(message, 8), -90.0, 90.0);
  into.longitude_rad = kRadPerDeg * check.take(true, load_le<double>(message, 16), -180.0, 180.0);
  into.altitude_msl_m = check.take(true, load_le<double>(message, 24), -kMostHeight_m, kMostHeight_m);
  into.altitude_m =
      into.altitude_msl_m + check.take(true, load_le<float>(message, 32), -kMostHeight_m, kMostHeight_m);
  for (std::size_t i = 0; i < 3; ++i)
    into.position_sigma_N_m[i] = check.take_sigma(true, load_le<float>(message, 40 + 4 * i));
  return check.reason();
}

std::optional<RejectReason> read_velocity(Bytes message, EpochVelocity& into) {
  if (message.size() < kVelocityMessage) return RejectReason::length;
  if (load_le<std::uint32_t>(message, 0) != kSolutionComputed) return std::nullopt;
  const auto type = load_le<std::uint32_t>(message, 4);
  if (!is_velocity_type(type)) return RejectReason::field;
  if (type == static_cast<std::uint32_t>(SolutionType::none)) return std::nullopt;
  NumberCheck check;
  const double latency_s = check.take(true, load_le<float>(message, 8), 0.0, kMostAccuracy);
  const double speed_m_s = check.take(true, load_le<double>(message, 16), 0.0, kMostVelocity_m_s);
  const double track_rad = kRadPerDeg * check.take(true, load_le<double>(message, 24), -360.0, 360.0);
  const double up_m_s = check.take(true, load_le<double>(message, 32), -kMostVelocity_m_s, kMostVelocity_m_s);
  if (check.reason() || latency_s > kMostLatency_s) return check.reason();
  into.velocity_N_m_s = {speed_m_s * std::cos(track_rad), speed_m_s * std::sin(track_rad), -up_m_s};
  into.course_rad = as_course(track_rad);
  return std::nullopt;
}

std::optional<RejectReason> read_heading(Bytes message, Heading& into) {
  if (message.size() < kHeadingMessage) return RejectReason::length;
  if (load_le<std::uint32_t>(message, 0) != kSolutionComputed) return std::nullopt;
  const auto fix = fix_of_solution(load_le<std::uint32_t>(message, 4));
  if (!fix) return RejectReason::field;
  NumberCheck check;
  const double length_m = check.take(true, load_le<float>(message, 8), -1.0, kMostAccuracy);  // -1: not said
  const double heading_deg = check.take(true, load_le<float>(message, 12), 0.0, 360.0);
  (void)check.take(true, load_le<float>(message, 16), -90.0, 90.0);
  const double sigma_deg = check.take_sigma(true, load_le<float>(message, 24));
  if (check.reason()) return check.reason();
  into.to_another_vehicle = length_m > kMostOnAVehicle_m;
  if (*fix != GpsFix::rtk_fixed || sigma_deg >= kNoHeadingSigma_deg) return std::nullopt;
  into.sample.heading_rad = heading_of(heading_deg);
  into.sample.sigma_rad = kRadPerDeg * sigma_deg;
  return std::nullopt;
}

std::optional<RejectReason> read_time(Bytes message, DurationNs& ahead_of_utc_ns) {
  constexpr std::uint32_t kUtcValid = 1;
  constexpr double kMostLeapSeconds = 100.0;
  if (message.size() < kTimeMessage) return RejectReason::length;
  if (load_le<std::uint32_t>(message, 40) != kUtcValid) return std::nullopt;
  NumberCheck check;
  const double offset_s = check.take(true, load_le<double>(message, 20), -kMostLeapSeconds, 1.0);
  if (!check.reason()) ahead_of_utc_ns = from_seconds(-offset_s);
  return check.reason();
}

}  // namespace fathom::codec::novatel
