#pragma once

#include <cstdint>
#include <optional>

#include "base/time.hpp"

namespace fathom::codec {

/// Where GPS time begins: 1980-01-06, in Unix time.
inline constexpr TimeNs kGpsEpoch_ns = 315'964'800 * kNsPerSecond;
/// GPS time counts no leap seconds. It is so far ahead of UTC since 2017-01-01.
inline constexpr DurationNs kGpsAheadOfUtc_ns = 18 * kNsPerSecond;
inline constexpr DurationNs kGpsWeek_ns = 7 * 86'400 * kNsPerSecond;
/// A later week, after 2114, is none. Nanoseconds in 64 bits hold twice as many, and not all that a message
/// can name.
inline constexpr std::uint16_t kLastGpsWeek = 7'000;

/// From time since the GPS epoch to UTC, and back. A receiver may know the leap seconds of its day.
[[nodiscard]] constexpr TimeNs utc_of_gps(DurationNs gps_ns, DurationNs ahead_of_utc_ns = kGpsAheadOfUtc_ns) {
  return kGpsEpoch_ns - ahead_of_utc_ns + gps_ns;
}
[[nodiscard]] constexpr DurationNs gps_of_utc(TimeNs utc_ns) {
  return utc_ns - kGpsEpoch_ns + kGpsAheadOfUtc_ns;
}
/// Time since the GPS epoch; nothing where it cannot be.
[[nodiscard]] constexpr std::optional<DurationNs> gps_of_week(std::uint16_t week, std::uint32_t of_week_ms) {
  const DurationNs of_week_ns = of_week_ms * kNsPerMillisecond;
  if (week > kLastGpsWeek || of_week_ns >= kGpsWeek_ns) return std::nullopt;
  return week * kGpsWeek_ns + of_week_ns;
}
/// As most receivers count it.
[[nodiscard]] constexpr std::uint32_t time_of_week_ms(TimeNs utc_ns) {
  return static_cast<std::uint32_t>(gps_of_utc(utc_ns) % kGpsWeek_ns / kNsPerMillisecond);
}

/// What is left of a difference when whole periods are taken off, from -period/2 to period/2: between times
/// of the week the shorter way round.
[[nodiscard]] constexpr DurationNs remainder_of(DurationNs value, DurationNs period) {
  const DurationNs rest = ((value % period) + period) % period;
  return rest > period / 2 ? rest - period : rest;
}

}  // namespace fathom::codec
