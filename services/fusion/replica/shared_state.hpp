#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"
#include "fusion/replica/arrival_log.hpp"
#include "fusion/replica/replica.hpp"

namespace fathom::fusion {

/// All that one fusion service tells another one that is to go on as it does.
struct SharedState {
  TimeNs stamp_ns = 0;           ///< of the navigation state
  Name imu_sensor;               ///< the inertial unit listened to
  SampleGaps::Table last;        ///< the last sample of each stream that is in it
  std::vector<std::byte> image;  ///< of the engine
};

/// As an archive for the way, and back; the error says what is wrong with the bytes. The image is the
/// engine's to check.
void encode(const SharedState& state, std::vector<std::byte>& out);
[[nodiscard]] Result<SharedState> decode_shared(std::span<const std::byte> bytes);

/// Why what has arrived here does not go on from where the state ends, in words; empty when it does.
[[nodiscard]] std::string gap_between(const SharedState& state, const ArrivalLog& log);

}  // namespace fathom::fusion
