#pragma once

#include <functional>

#include "base/exit_code.hpp"

namespace CLI {
class App;
}

namespace fathom::cli {

/// main() of a program of sub-commands, which `add` adds. Says in a line each what is wrong with the command
/// line or ended the command. No option takes a number that is none, is endless or does not fit, and none an
/// empty text.
int run_program(int argc, char** argv, const std::function<void(CLI::App& app, ExitCode& exit_code)>& add);

}  // namespace fathom::cli
