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
struct Command {
  std::string name;
  std::function<void(CLI::App& app, ExitCode& exit_code)> add;
};

/// main() of a program of sub-commands. Only the one that is asked for is added, where there is such a one.
/// Says in a line each what is wrong with the command line or ended the command. No option takes a number
/// that is none, is endless or does not fit, and none an empty text.
int run_program(int argc, char** argv, const std::vector<Command>& commands);

}  // namespace fathom::cli
