#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/time.hpp"
#include "samples/gps.hpp"
#include "samples/imu.hpp"

namespace fathom::sim::encode {

/// A fix of the receiver in a VN-200 or VN-300, and its UTC.
struct VectornavFix {
  GpsSample sample;
  TimeNs utc_ns = 0;
};

/// One VectorNav binary frame as a VN-100 sends it: TimeStartup (64-bit nanoseconds), uncompensated rate and
/// specific force, and where the sample knows them increments with their interval and temperature. With
/// `utc_ns` also TimeGps and TimeStatus, all valid. Rates and forces are single precision, as in the
/// protocol. Unknown rates or forces are left out of the frame. With `fix` the fields of vectornav_fix()
/// follow.
[[nodiscard]] std::vector<std::uint8_t> vectornav(const ImuSample& sample, DurationNs since_startup_ns,
                                                  std::optional<TimeNs> utc_ns = std::nullopt,
                                                  const VectornavFix* fix = nullptr);

/// One frame with the group GNSS1 alone: Tow, Week, NumSats, Fix, PosLla, VelNed, PosU, VelU, TimeInfo with
/// all valid, and DOP. Degrees are double precision, the rest is single. VelU is the largest velocity sigma.
/// The protocol has no dead reckoning: it is no fix.
[[nodiscard]] std::vector<std::uint8_t> vectornav_fix(const VectornavFix& fix);

}  // namespace fathom::sim::encode
