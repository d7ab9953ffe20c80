#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "cli/bench/cases.hpp"
#include "cli/command.hpp"

namespace fathom::cli {
namespace {

struct BenchOptions {
  std::string json;
  int rounds = 200;
};

void print(const BenchRow& row) {
  std::printf("%-36s %12.4g %12.4g %8.3f  %s\n", row.name.c_str(), row.value, row.floor, row.ratio,
              row.unit.c_str());
  std::fflush(stdout);
}

void run(const BenchOptions& options, bool json_asked) {
  const bool to_file = !options.json.empty() && options.json != "-";
  // Whoever reads it from a pipe wants the figures, who sits at a terminal the table.
  const bool to_output = (json_asked && !to_file) || (!json_asked && isatty(STDOUT_FILENO) == 0);
  std::ofstream file;
  if (to_file) {
    file.open(options.json);
    if (!file) {
      throw Failure(ExitCode::runtime_failure,
                    options.json + ": cannot be written, expected a writable path");
    }
  }
  if (!to_output) std::printf("%-36s %12s %12s %8s  %s\n", "", "value", "floor", "ratio", "unit");
  nlohmann::ordered_json out;
  out["rows"] = nlohmann::ordered_json::array();
  run_bench(options.rounds, [&](const BenchRow& row) {
    out["rows"].push_back({{"name", row.name},
                           {"unit", row.unit},
                           {"value", row.value},
                           {"floor", row.floor},
                           {"ratio", row.ratio}});
    if (!to_output) print(row);
  });
  const std::string text = out.dump(1) + "\n";
  if (to_output) std::fputs(text.c_str(), stdout);
  if (!to_file) return;
  file << text;
  file.close();
  if (!file) throw Failure(ExitCode::runtime_failure, options.json + ": could not be written to its end");
}

}  // namespace

void add_bench(CLI::App& app, ExitCode&) {
  auto options = std::make_shared<BenchOptions>();
  auto* command = app.add_subcommand(
      "bench",
      "Performance of the estimator, each figure beside its floor measured in the same rounds: a step of the "
      "filter against the dense product, an update against the dense Joseph form, whole engines in samples "
      "per "
      "second, and what a late fix costs. A table on a terminal, JSON elsewhere.");
  auto* json = command
                   ->add_option("--json", options->json,
                                "JSON to this file; without a name or with - to standard output")
                   ->expected(0, 1)
                   ->default_str("-");
  command->add_option("--rounds", options->rounds, "interleaved rounds of each figure")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  command->callback([options, json] { run(*options, json->count() > 0); });
}

}  // namespace fathom::cli
