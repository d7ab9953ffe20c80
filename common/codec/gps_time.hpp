#pragma once

#include "base/time.hpp"

namespace fathom::codec {

/// Where GPS time begins: 1980-01-06, in Unix time.
inline constexpr TimeNs kGpsEpoch_ns = 315'964'800 * kNsPerSecond;
/// GPS time counts no leap seconds. It is so far ahead of UTC since 2017-01-01.
inline constexpr DurationNs kGpsAheadOfUtc_ns = 18 * kNsPerSecond;
inline constexpr DurationNs kGpsWeek_ns = 7 * 86'400 * kNsPerSecond;

/// From time since the GPS epoch to UTC, and back.
[[nodiscard]] constexpr TimeNs utc_of_gps(DurationNs gps_ns) {
  return kGpsEpoch_ns - kGpsAheadOfUtc_ns + gps_ns;
}
[[nodiscard]] constexpr DurationNs gps_of_utc(TimeNs utc_ns) {
  return utc_ns - kGpsEpoch_ns + kGpsAheadOfUtc_ns;
}

}  // namespace fathom::codec
