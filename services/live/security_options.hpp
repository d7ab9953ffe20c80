#pragma once

#include "bus/participant.hpp"

namespace CLI {
class App;
}

namespace fathom::cli {

/// Adds what a command needs to join a protected network: `--security DIR`, or FATHOM_SECURITY_DIR in the
/// environment, and `--identity NAME`, "cli" unless told otherwise.
void add_security_options(CLI::App& command, bus::SecurityOptions& security);

}  // namespace fathom::cli
