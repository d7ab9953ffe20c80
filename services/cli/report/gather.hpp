#pragma once

#include <string>

#include "cli/solve/run.hpp"
#include "report/material.hpp"

namespace fathom::cli {

/// Runs the engine over the data and keeps what a report shows. `solve_run.on_state` and `on_verdict` are not
/// used.
[[nodiscard]] report::Material gather(const SolveRun& solve_run, TimeNs epoch_ns);

}  // namespace fathom::cli
