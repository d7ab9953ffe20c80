#include <vector>

#include "cli/command.hpp"
#include "cli/explain/explain.hpp"
#include "cli/live_commands.hpp"
#include "cli/program.hpp"

namespace fathom::cli {

std::vector<SubCommand> commands(char** argv) {
  const auto live = [argv](const LiveCommand& command) {
    return SubCommand{command.name,
                      [argv, &command](CLI::App& app, ExitCode&) { add_live_command(app, command, argv); }};
  };
  return {
      {"decode", add_decode},
      live(kStatus),
      live(kFix),
      {"solve", add_solve},
      {"commission", add_commission},
      {"simulate", add_simulate},
      {"study", add_study},
      {"bench", add_bench},
      live(kDoctor),
      {"config", add_config},
      {"init", add_init},
      {"run", add_run},
      {"keygen", add_keygen},
      {"import", add_import},
      {"export", add_export},
      {"explain",
       [argv](CLI::App& app, ExitCode& exit_code) {
         add_explain(app, exit_code, [argv](const LiveOptions&) -> explain::History { hand_over(argv); });
       }},
      {"report", add_report},
      {"plot", add_plot},
      live(kRecord),
      live(kReplay),
  };
}

}  // namespace fathom::cli
