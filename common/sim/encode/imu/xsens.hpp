#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/time.hpp"
#include "samples/gps.hpp"
#include "samples/imu.hpp"

namespace fathom::sim::encode {

/// One MTData2 message as an MTi sends it: PacketCounter, SampleTimeFine in whole 100 us, with `utc_ns`
/// UtcTime, then what the sample knows of RateOfTurn, Acceleration, DeltaQ with DeltaV, and Temperature, in
/// single precision and in the unit's axes (forward, left, up).
[[nodiscard]] std::vector<std::uint8_t> xsens(const ImuSample& sample, std::uint16_t counter,
                                              DurationNs since_startup_ns,
                                              std::optional<TimeNs> utc_ns = std::nullopt);

/// One MTData2 message with the fix of the receiver in the unit, item GNSS PVT Data, as pvt_fields()
/// (pvt.hpp) rounds it, and its horizontal dilution in hundredths.
[[nodiscard]] std::vector<std::uint8_t> xsens_fix(const GpsSample& sample, TimeNs utc_ns);

/// The items of one MTData2 message, or of two in one, as a unit sends them that is set up so.
[[nodiscard]] std::vector<std::uint8_t> xsens_together(const std::vector<std::uint8_t>& first,
                                                       const std::vector<std::uint8_t>& second);

/// A message of any kind, with its checksum; extended where its data ask for it.
[[nodiscard]] std::vector<std::uint8_t> xsens_message(std::uint8_t message,
                                                      const std::vector<std::uint8_t>& data);

}  // namespace fathom::sim::encode
