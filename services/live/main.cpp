#include "cli/explain/explain.hpp"
#include "cli/live_commands.hpp"
#include "cli/program.hpp"
#include "live/command.hpp"
#include "live/explain/read_live.hpp"

int main(int argc, char** argv) {
  using namespace fathom::cli;
  const auto explain = [](CLI::App& app, fathom::ExitCode& exit_code) {
    add_explain(app, exit_code, read_live);
  };
  return run_program(argc, argv,
                     {{kStatus.name, add_status},
                      {kFix.name, add_fix},
                      {kDoctor.name, add_doctor},
                      {"explain", explain},
                      {kRecord.name, add_record},
                      {kReplay.name, add_replay}});
}
