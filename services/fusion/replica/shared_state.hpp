#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"
#include "fusion/intake/arrival_log.hpp"
#include "fusion/intake/sample_gaps.hpp"

namespace fathom::fusion {

/// The state that one fusion service gives to another one, which then goes on as the first one does.
struct SharedState {
  TimeNs stamp_ns = 0;             ///< of the navigation state
  Name imu_sensor;                 ///< the inertial unit in use
  SampleGaps::Table last;          ///< the last sample of each stream that the state holds
  std::vector<std::byte> archive;  ///< of the engine
};

/// Writes the state as bytes, and reads it. The error says what is wrong with the bytes. The engine checks
/// the archive itself.
void encode(const SharedState& state, std::vector<std::byte>& out);
[[nodiscard]] Result<SharedState> decode_shared(std::span<const std::byte> bytes);

/// Why the logged arrivals do not go on from where the state ends, in words. Empty when they do.
[[nodiscard]] std::string gap_between(const SharedState& state, const ArrivalLog& log);

}  // namespace fathom::fusion
