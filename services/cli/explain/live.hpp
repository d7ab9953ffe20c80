#pragma once

#include <string>

#include "bus/participant.hpp"
#include "explain/history.hpp"

namespace fathom::cli {

struct LiveOptions {
  bus::ParticipantOptions bus;
  std::string vehicle;     ///< empty: the one that is heard first
  double last_s = 600.0;   ///< of what a recorder has
  double listen_s = 60.0;  ///< without one
};

/// What a running vehicle said. Where a recorder runs on this host its files have the last `last_s` seconds;
/// else what comes is listened to for `listen_s`. Standard error tells which. Throws Failure.
[[nodiscard]] explain::History read_live(const LiveOptions& options);

}  // namespace fathom::cli
