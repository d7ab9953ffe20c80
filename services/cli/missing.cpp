#include <CLI/CLI.hpp>

#include "cli/command.hpp"

namespace fathom::cli {

void add_missing(CLI::App& app) {
  CLI::App* record = app.add_subcommand("record", "Not in this build: there is no recorder yet.");
  record->allow_extras();
  record->callback([] {
    throw Failure(ExitCode::bad_configuration,
                  "record: this build has no recorder yet; see --help for what it has");
  });
}

}  // namespace fathom::cli
