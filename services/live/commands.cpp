#include <vector>

#include "cli/explain/explain.hpp"
#include "cli/live_commands.hpp"
#include "live/command.hpp"
#include "live/explain/read_live.hpp"

namespace fathom::cli {

std::vector<SubCommand> live_commands() {
  const auto explain = [](CLI::App& app, ExitCode& exit_code) { add_explain(app, exit_code, read_live); };
  return {{kStatus.name, add_status}, {kFix.name, add_fix},       {kDoctor.name, add_doctor},
          {"explain", explain},       {kRecord.name, add_record}, {kReplay.name, add_replay}};
}

}  // namespace fathom::cli
