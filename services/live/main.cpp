#include "cli/explain/explain.hpp"
#include "cli/program.hpp"
#include "live/command.hpp"
#include "live/explain/read_live.hpp"

int main(int argc, char** argv) {
  using namespace fathom::cli;
  return run_program(argc, argv, [](CLI::App& app, fathom::ExitCode& exit_code) {
    add_status(app, exit_code);
    add_fix(app, exit_code);
    add_doctor(app, exit_code);
    add_explain(app, exit_code, read_live);
    add_record(app, exit_code);
    add_replay(app, exit_code);
  });
}
