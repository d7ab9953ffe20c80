#pragma once

#include "base/exit_code.hpp"
#include "demo/options.hpp"

namespace fathom::demo {

/// Starts everything, watches until the time is up or SIGINT or SIGTERM comes, stops everything, judges.
/// `done` when every demand was met, `no` otherwise.
[[nodiscard]] ExitCode run(const Options& options);

}  // namespace fathom::demo
