#pragma once

#include <filesystem>
#include <string>

#include "config/fusion/fusion_config.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "fusion/checkpoint/checkpoint.hpp"

namespace fathom::fusion {

/// How an engine came to its state.
struct Resumption {
  bool resumed = false;
  bool refused = false;  ///< there was a checkpoint, and it was put aside
  std::string how;       ///< in words
};

/// Goes on from the checkpoint where there is one that may be gone on from. One that may not be is put aside
/// as PATH.refused, and the engine is as it was.
///
/// While it is being tried the file is called PATH.tried, until the first new checkpoint is written: a state
/// that ends the process is met once more, in case something else did, and not a third time.
[[nodiscard]] Resumption resume(estimation::FusionEngine& engine, const config::CheckpointConfig& config,
                                const CheckpointLabel& own);

/// What is left of the trial once a new checkpoint stands.
void forget_trial(const std::filesystem::path& checkpoint);

}  // namespace fathom::fusion
