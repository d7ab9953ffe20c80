#pragma once

#include "cli/explain/explain.hpp"

namespace fathom::cli {

/// What a running vehicle said. Where a recorder runs on this host its files have the last `last_s` seconds;
/// else what comes is listened to for `listen_s`. Standard error tells which. Throws Failure.
[[nodiscard]] explain::History read_live(const LiveOptions& options);

}  // namespace fathom::cli
