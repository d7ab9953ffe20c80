#pragma once

#include "bus/participant.hpp"

namespace CLI {
class App;
}

namespace fathom::cli {

/// Adds what a command needs to be present on the vehicle network: `--domain`, `--interface`, `--peer`,
/// `--discovery-server`, `--profiles`, `--security` and
/// `--identity`.
void add_bus_options(CLI::App& command, bus::ParticipantOptions& options, const std::string& identity);

}  // namespace fathom::cli
