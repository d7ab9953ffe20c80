#pragma once

#include <string>

#include "bus/participant.hpp"

namespace CLI {
class App;
}

namespace fathom::cli {

/// Adds what a command needs to be present on the vehicle network: `--domain`, `--interface`, `--peer`,
/// `--discovery-server`, `--profiles`; and where that network is protected `--security DIR`, or
/// FATHOM_SECURITY_DIR in the environment, and `--identity NAME`, which is `identity` unless told otherwise.
void add_bus_options(CLI::App& command, bus::ParticipantOptions& options, const std::string& identity);

}  // namespace fathom::cli
