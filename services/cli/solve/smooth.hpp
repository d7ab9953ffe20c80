#pragma once

#include <functional>

#include "cli/solve/run.hpp"

namespace fathom::cli {

/// What a run through the smoother shows, each in the order of time; either may be empty.
struct SmoothedStates {
  std::function<void(const NavState&)> filtered;  ///< the forward pass
  std::function<void(const NavState&)> smoothed;
};

/// Hands every sample to the smoother: forward with each measurement at its own instant, then backward.
/// `solve_run.on_state` is not used. Keeps one NavState per inertial sample until the end.
[[nodiscard]] SolveResult run_smoothed(const SolveRun& solve_run, const SmoothedStates& states);

}  // namespace fathom::cli
