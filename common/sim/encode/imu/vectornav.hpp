#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/time.hpp"
#include "samples/imu.hpp"

namespace fathom::sim::encode {

/// One VectorNav binary frame as a VN-100 sends it: TimeStartup (64-bit nanoseconds), uncompensated rate and
/// specific force, and where the sample knows them increments with their interval and temperature. With
/// `utc_ns` also TimeGps and TimeStatus, all valid. Rates and forces are single precision, as in the
/// protocol. Unknown rates or forces are left out of the frame.
[[nodiscard]] std::vector<std::uint8_t> vectornav(const ImuSample& sample, DurationNs since_startup_ns,
                                                  std::optional<TimeNs> utc_ns = std::nullopt);

}  // namespace fathom::sim::encode
