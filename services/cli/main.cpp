#include "cli/command.hpp"
#include "cli/explain/explain.hpp"
#include "cli/live_commands.hpp"
#include "cli/program.hpp"

namespace fathom::cli {
namespace {

void add_commands(CLI::App& app, ExitCode& exit_code, char** argv) {
  add_decode(app, exit_code);
  add_live_command(app, kStatus, argv);
  add_live_command(app, kFix, argv);
  add_solve(app, exit_code);
  add_commission(app, exit_code);
  add_simulate(app, exit_code);
  add_study(app, exit_code);
  add_bench(app, exit_code);
  add_live_command(app, kDoctor, argv);
  add_config(app, exit_code);
  add_init(app, exit_code);
  add_run(app, exit_code);
  add_keygen(app, exit_code);
  add_import(app, exit_code);
  add_export(app, exit_code);
  add_explain(app, exit_code, [argv](const LiveOptions&) -> explain::History { hand_over(argv); });
  add_report(app, exit_code);
  add_plot(app, exit_code);
  add_live_command(app, kRecord, argv);
  add_live_command(app, kReplay, argv);
}

}  // namespace
}  // namespace fathom::cli

int main(int argc, char** argv) {
  return fathom::cli::run_program(argc, argv, [argv](CLI::App& app, fathom::ExitCode& exit_code) {
    fathom::cli::add_commands(app, exit_code, argv);
  });
}
