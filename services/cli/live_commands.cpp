#include "cli/live_commands.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "cli/command.hpp"
#include "launch/executable.hpp"

namespace fathom::cli {

void add_live_command(CLI::App& app, const LiveCommand& command, char** argv) {
  CLI::App* added = app.add_subcommand(command.name, command.description);
  added->prefix_command();
  added->set_help_flag();  // --help is one of the words that follow
  added->callback([argv] { hand_over(argv); });
}

void hand_over(char** argv) {
  const std::string program = (launch::executables_folder() / launch::executable_of("live")).string();
  execv(program.c_str(), argv);
  throw Failure(
      ExitCode::runtime_failure,
      program + ": " + std::strerror(errno) + ", expected the part of fathom that joins the vehicle network");
}

}  // namespace fathom::cli
