#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/exit_code.hpp"

namespace CLI {
class App;
}

namespace fathom::cli {

/// A sub-command: its name, and what adds it with its options.
struct SubCommand {
  std::string name;
  std::function<void(CLI::App& app, ExitCode& exit_code)> add;
};

/// Adds commands. No option takes a number that is none, is endless or does not fit, and none an empty text.
void add(CLI::App& app, const std::vector<SubCommand>& commands, ExitCode& exit_code);

/// main() of a program of sub-commands. Only the one that is asked for is added, where there is such a one.
/// Says in a line each what is wrong with the command line or ended the command.
int run_program(int argc, char** argv, const std::vector<SubCommand>& commands);

}  // namespace fathom::cli
