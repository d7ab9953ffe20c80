#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/time.hpp"
#include "samples/imu.hpp"

namespace fathom::sim::encode {

/// One MTData2 message as an MTi sends it: PacketCounter, SampleTimeFine in whole 100 us, with `utc_ns`
/// UtcTime, then what the sample knows of RateOfTurn, Acceleration, DeltaQ with DeltaV, and Temperature, in
/// single precision and in the unit's axes (forward, left, up).
[[nodiscard]] std::vector<std::uint8_t> xsens(const ImuSample& sample, std::uint16_t counter,
                                              DurationNs since_startup_ns,
                                              std::optional<TimeNs> utc_ns = std::nullopt);

/// A message of any kind, with its checksum; extended where its data ask for it.
[[nodiscard]] std::vector<std::uint8_t> xsens_message(std::uint8_t message,
                                                      const std::vector<std::uint8_t>& data);

}  // namespace fathom::sim::encode
