#pragma once

#include <vector>

#include "base/exit_code.hpp"
#include "cli/program.hpp"

namespace CLI {
class App;
}

namespace fathom::cli {

// The commands that join the vehicle network, each a file of its own (cli/command.hpp).

void add_status(CLI::App& app, ExitCode& exit_code);
void add_fix(CLI::App& app, ExitCode& exit_code);
void add_doctor(CLI::App& app, ExitCode& exit_code);
void add_record(CLI::App& app, ExitCode& exit_code);
void add_replay(CLI::App& app, ExitCode& exit_code);

/// Those of fathom-live.
[[nodiscard]] std::vector<SubCommand> live_commands();

}  // namespace fathom::cli
