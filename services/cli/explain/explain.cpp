#include "explain/explain.hpp"

#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/command.hpp"
#include "cli/explain/read.hpp"
#include "cli/recording.hpp"
#include "explain/sentence.hpp"

namespace fathom::cli {

void add_explain(CLI::App& app, ExitCode& exit_code) {
  auto file = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("explain", "Says what happened in a recording, causes first.");
  command->add_option("file", *file, "recording (.mcap)")->required();
  command->callback([file, &exit_code] {
    record::Reader reader = open_recording(*file);
    explain::History history;
    for (const std::string& p : read_into(history, reader, {})) std::fprintf(stderr, "%s\n", p.c_str());
    for (const explain::Finding& one : explain::findings(history)) {
      std::printf("%s %s %+.1f..%+.1f %s%s\n", std::string(to_string(one.weight)).c_str(),
                  std::string(to_string(one.kind)).c_str(), to_seconds(one.begin_ns - history.from_ns()),
                  to_seconds(one.end_ns - history.from_ns()), explain::sentence(one).c_str(),
                  one.follows_from ? (" <- " + std::to_string(*one.follows_from)).c_str() : "");
    }
    (void)exit_code;
  });
}

}  // namespace fathom::cli
