#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/time.hpp"
#include "samples/gps.hpp"
#include "samples/imu.hpp"

namespace fathom::sim::encode {

/// One packet of sensor data as a 3DM-CV7 sends it: reference time in nanoseconds, with a known interval its
/// delta, with `utc_ns` the GPS timestamp, then what the sample knows of scaled accelerometer and gyro, delta
/// theta and delta velocity, in single precision. A packet has no temperature.
[[nodiscard]] std::vector<std::uint8_t> microstrain(const ImuSample& sample, DurationNs since_startup_ns,
                                                    std::optional<TimeNs> utc_ns = std::nullopt);

/// One packet of a receiver's set: GPS time, fix info, position, velocity and dilution. The accuracies are
/// the larger one of north and east, and the largest one of the velocity; an estimated position is an invalid
/// fix.
[[nodiscard]] std::vector<std::uint8_t> microstrain_gnss(const GpsSample& sample, TimeNs utc_ns,
                                                         std::uint8_t descriptor_set = 0x91);

/// A packet of any descriptor set, with its checksum; `fields` of at most 255 bytes.
[[nodiscard]] std::vector<std::uint8_t> microstrain_packet(std::uint8_t descriptor_set,
                                                           const std::vector<std::uint8_t>& fields);

}  // namespace fathom::sim::encode
