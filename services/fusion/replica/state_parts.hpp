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

/// Most bytes of a state that travel: 128 parts, as many as a reader's history holds.
inline constexpr std::size_t kMostParts = 128;

/// Calls `send` with each part of `bytes`; `head` has what all parts share. False when they are too many.
bool send_in_parts(EngineStatePart head, std::span<const std::byte> bytes,
                   const std::function<void(const EngineStatePart&)>& send);

/// Puts the parts of a state together. One state at a time: the first part of another one, or of another
/// writer, ends what was begun.
class StateAssembler {
 public:
  struct Whole {
    EngineStatePart head;  ///< what all parts share
    std::vector<std::byte> bytes;
  };
  /// A state when this part was the last that it lacked.
  [[nodiscard]] std::optional<Whole> add(const EngineStatePart& part, const WriterGuid& writer);

 private:
  WriterGuid writer_{};
  Whole whole_;
  std::uint32_t next_ = 0;  ///< part expected; parts of one writer come in order
};

}  // namespace fathom::fusion
