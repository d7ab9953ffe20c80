#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "bus/participant.hpp"
#include "samples/status/replication.hpp"

namespace fathom::fusion {

/// Largest state that can be sent: 128 parts, as many as a reader's history holds.
inline constexpr std::size_t kMostParts = 128;

/// Calls `send` with each part of `bytes`. `head` has what all parts share. False when there are too many
/// parts.
bool send_in_parts(EngineStatePart head, std::span<const std::byte> bytes,
                   const std::function<void(const EngineStatePart&)>& send);

/// Puts the parts of a state together, one state at a time. The first part of another state, or of another
/// writer, drops the parts before it.
class StateAssembler {
 public:
  struct Whole {
    EngineStatePart head;  ///< what all parts share
    std::vector<std::byte> bytes;
  };
  /// Adds a part. Returns the state when it is complete.
  [[nodiscard]] std::optional<Whole> add(const EngineStatePart& part, const WriterGuid& writer);

 private:
  WriterGuid writer_{};
  Whole whole_;
  std::uint32_t next_ = 0;  ///< expected part; parts of one writer come in order
};

}  // namespace fathom::fusion
