#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "archive/checkpoint.hpp"
#include "config/fusion/fusion_config.hpp"
#include "estimation/engine/fusion_engine.hpp"

namespace fathom::fusion {

/// How an engine came to its state.
struct Resumption {
  bool resumed = false;
  bool refused = false;      ///< there was a checkpoint, and it was put aside
  std::string how;           ///< in words
  TimeNs stamp_ns = 0;       ///< where resumed: of the state
  std::uint64_t digest = 0;  ///< likewise, of its archive
};

/// Restores the engine from the checkpoint, when there is one that it may go on from. Another checkpoint is
/// put aside as PATH.refused, and the engine stays as it was.
///
/// The file is called PATH.tried until the first new checkpoint is written. So a state that ends the process
/// is tried a second time, because something else may have ended it, and not a third time.
[[nodiscard]] Resumption resume(estimation::FusionEngine& engine, const config::CheckpointConfig& config,
                                const archive::CheckpointLabel& own);

/// Removes PATH.tried after a new checkpoint was written.
void forget_trial(const std::filesystem::path& checkpoint);

}  // namespace fathom::fusion
