#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fathom {

/// Nanoseconds since the Unix epoch, UTC, unless a name says otherwise.
using TimeNs = std::int64_t;
/// A difference of two TimeNs.
using DurationNs = std::int64_t;

inline constexpr DurationNs kNsPerSecond = 1'000'000'000;
inline constexpr DurationNs kNsPerMillisecond = 1'000'000;

[[nodiscard]] constexpr double to_seconds(DurationNs ns) {
  return static_cast<double>(ns) * 1e-9;
}

/// Rounds to the nearest nanosecond. Values beyond +-292 years saturate, NaN becomes 0.
[[nodiscard]] DurationNs from_seconds(double seconds);

/// Nearer to 1970 than 146 years: such stamps can be added to and subtracted from each other. Instruments and
/// networks may deliver others.
[[nodiscard]] constexpr bool sound_stamp(TimeNs stamp_ns) {
  constexpr TimeNs kMost = TimeNs{1} << 62;
  return stamp_ns >= -kMost && stamp_ns <= kMost;
}

/// A civil UTC instant as instruments report it.
struct CivilTime {
  int year = 1970;
  int month = 1;
  int day = 1;
  int hour = 0;
  int minute = 0;
  int second = 0;  ///< 60 is accepted: a leap second counts as the first instant of the next minute
  std::int64_t nanosecond = 0;  ///< may be negative (u-blox `nano`): it is added to the second
};

/// Nothing when a field lies outside its range (13th month, 30 February, 25 o'clock, year before 1970 or past
/// 2261).
[[nodiscard]] std::optional<TimeNs> from_civil(const CivilTime& civil);
[[nodiscard]] CivilTime to_civil(TimeNs utc);

/// ISO 8601 with Z and `decimals` digits of the second, e.g. 2026-01-31T12:00:00.250Z.
[[nodiscard]] std::string to_iso8601(TimeNs utc, int decimals = 3);

}  // namespace fathom
