#include "codec/satellite/ubx_heading.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/gps_time.hpp"

namespace fathom::codec {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kRelposnedLength = 64;
constexpr double kAngleUnit_deg = 1e-5;
constexpr std::int32_t kTurn_units = 36'000'000;
constexpr double kMostAccuracy_deg = 180.0;
constexpr DurationNs kSolutionHolds_ns = 10 * kNsPerSecond;

/// Of the flags.
constexpr std::uint32_t kWithinLimits = 1U << 0U;
constexpr std::uint32_t kPositionValid = 1U << 2U;
constexpr unsigned kCarrierAt = 3;  // two bits: none, float, fixed
constexpr std::uint32_t kMoving = 1U << 5U;
constexpr std::uint32_t kHeadingValid = 1U << 8U;

bool is_good(std::uint32_t flags) {
  constexpr std::uint32_t kWanted = kWithinLimits | kPositionValid | kHeadingValid;
  constexpr unsigned kCarrierFixed = 2;
  return (flags & kWanted) == kWanted && (flags >> kCarrierAt & 3U) == kCarrierFixed;
}

}  // namespace

std::optional<UbxHeading::Found> UbxHeading::read(Bytes payload) const {
  if (payload.empty() || payload[0] != kVersion) return std::nullopt;
  Found out;
  if (payload.size() != kRelposnedLength) {
    out.refused = RejectReason::length;
    return out;
  }
  const auto flags = load_le<std::uint32_t>(payload, 60);
  if ((flags & kMoving) == 0) return std::nullopt;
  const auto time_of_week_ms = load_le<std::uint32_t>(payload, 4);
  if (utc_ns_) {
    const DurationNs apart_ms = DurationNs{time_of_week_ms} - DurationNs{time_of_week_ms_};
    const DurationNs later_ns = remainder_of(apart_ms * kNsPerMillisecond, kGpsWeek_ns);
    if (std::abs(later_ns) <= kSolutionHolds_ns) out.time.utc_ns = *utc_ns_ + later_ns;
  }
  if (!is_good(flags)) return out;
  const auto heading_units = load_le<std::int32_t>(payload, 24);
  const double accuracy_deg = load_le<std::uint32_t>(payload, 52) * kAngleUnit_deg;
  if (heading_units < -kTurn_units || heading_units > kTurn_units) {
    out.refused = RejectReason::out_of_range;
    return out;
  }
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  out.sample.heading_rad = std::fmod(heading_units * kAngleUnit_deg * kRadPerDeg + kTurn_rad, kTurn_rad);
  if (accuracy_deg > 0.0 && accuracy_deg < kMostAccuracy_deg)
    out.sample.sigma_rad = accuracy_deg * kRadPerDeg;
  return out;
}

void UbxHeading::note(std::uint32_t time_of_week_ms, const std::optional<TimeNs>& utc_ns) {
  time_of_week_ms_ = time_of_week_ms;
  utc_ns_ = utc_ns;
}

}  // namespace fathom::codec
