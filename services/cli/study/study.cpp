#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/large_pages.hpp"
#include "cli/progress.hpp"
#include "cli/study/scenarios.hpp"
#include "config/registry.hpp"
#include "runtime/build_info.hpp"
#include "study/registry.hpp"
#include "study/runner.hpp"

namespace fathom::cli {
namespace {

struct StudyOptions {
  std::string name;
  std::string json;
  study::RunOptions run;
  int runs = 0;
};

std::string names() {
  std::string text;
  for (const auto& one : study::study_registry())
    text += (text.empty() ? "" : ", ") + std::string(one->name());
  return text + ", scenarios";
}

std::string description() {
  std::string text =
      "Monte Carlo of a published experiment: the estimators against simulated truth, over many seeds.";
  for (const auto& one : study::study_registry()) {
    text += "\n  " + std::string(one->name()) + ": " + std::string(one->description()) + "\n    cases";
    for (const auto name : one->cases()) text += " " + std::string(name);
    text += "\n    methods";
    for (const auto name : one->methods()) text += " " + std::string(name);
  }
  return text + "\n  scenarios: the demonstration's scenarios offline, through device bytes and codecs";
}

void print(const std::vector<study::Row>& rows) {
  const auto width = [&](const char* title, auto field) {
    std::size_t widest = std::string_view(title).size();
    for (const study::Row& row : rows) widest = std::max(widest, field(row).size());
    return static_cast<int>(widest);
  };
  const int w_case = width("case", [](const study::Row& row) { return row.case_name; });
  const int w_method = width("method", [](const study::Row& row) { return row.method; });
  const int w_metric = width("metric", [](const study::Row& row) { return row.metric; });
  const int w_unit = width("unit", [](const study::Row& row) { return row.unit; });
  std::printf("%-*s  %-*s  %-*s  %-*s  %5s  %7s", w_case, "case", w_method, "method", w_metric, "metric",
              w_unit, "unit", "n", "missing");
  for (const char* title : {"mean", "std", "rms", "median", "p05", "p95", "max"}) std::printf("  %9s", title);
  std::printf("\n");
  for (const study::Row& row : rows) {
    const study::Statistics& s = row.statistics;
    std::printf("%-*s  %-*s  %-*s  %-*s  %5zu  %7zu", w_case, std::string(row.case_name).c_str(), w_method,
                std::string(row.method).c_str(), w_metric, std::string(row.metric).c_str(), w_unit,
                std::string(row.unit).c_str(), s.n, row.missing);
    for (const double value : {s.mean, s.std, s.rms, s.median, s.p05, s.p95, s.max}) {
      if (known(value)) {
        std::printf("  %9.4g", value);
      } else {
        std::printf("  %9s", "-");
      }
    }
    std::printf("\n");
  }
}

nlohmann::ordered_json json_of(const StudyOptions& options, const std::vector<study::Row>& rows) {
  nlohmann::ordered_json out;
  out["study"] = options.name;
  out["runs"] = options.run.runs;
  out["seed"] = options.run.seed;
  out["version"] = std::string(runtime::version());
  out["rows"] = nlohmann::ordered_json::array();
  for (const study::Row& row : rows) {
    const study::Statistics& s = row.statistics;
    // What is unknown is written as null.
    out["rows"].push_back({{"case", row.case_name},
                           {"method", row.method},
                           {"metric", row.metric},
                           {"unit", row.unit},
                           {"n", s.n},
                           {"missing", row.missing},
                           {"mean", s.mean},
                           {"std", s.std},
                           {"rms", s.rms},
                           {"median", s.median},
                           {"p05", s.p05},
                           {"p95", s.p95},
                           {"max", s.max}});
  }
  return out;
}

std::unique_ptr<const study::Study> scenario_study() {
  try {
    return make_scenario_study();
  } catch (const config::ConfigError& error) {
    throw Failure(ExitCode::bad_configuration, error.what());
  }
}

void run(StudyOptions options) {
  const auto scenarios = options.name == "scenarios" ? scenario_study() : nullptr;
  const study::Study* one = scenarios ? scenarios.get() : study::find_study(options.name);
  if (one == nullptr) {
    throw Failure(ExitCode::bad_configuration,
                  "study: " + options.name + ": no such study, expected one of " + names());
  }
  options.run.runs = options.runs > 0 ? options.runs : one->default_runs();
  // A long run must not end with a file that cannot be written.
  std::ofstream file;
  const bool to_file = !options.json.empty() && options.json != "-";
  if (to_file) {
    file.open(options.json);
    if (!file) {
      throw Failure(ExitCode::runtime_failure,
                    options.json + ": cannot be written, expected a writable path");
    }
  }
  const std::size_t cases = options.run.cases.empty() ? one->cases().size() : options.run.cases.size();
  std::vector<study::Row> rows;
  {
    Progress progress("study " + options.name, cases * static_cast<std::size_t>(options.run.runs));
    options.run.progress = [&progress](std::size_t done, std::size_t) { progress.update(done); };
    try {
      rows = study::run_study(*one, options.run);
    } catch (const std::invalid_argument& error) {
      throw Failure(ExitCode::bad_configuration, "study " + options.name + ": " + error.what());
    }
  }
  if (options.json != "-") print(rows);
  if (options.json.empty()) return;
  const std::string text = json_of(options, rows).dump(1) + "\n";
  if (!to_file) {
    std::fputs(text.c_str(), stdout);
    return;
  }
  file << text;
  file.close();
  if (!file) throw Failure(ExitCode::runtime_failure, options.json + ": could not be written to its end");
}

}  // namespace

void add_study(CLI::App& app, ExitCode&) {
  auto options = std::make_shared<StudyOptions>();
  options->run.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  auto* command = app.add_subcommand("study", description());
  command->add_option("name", options->name, "one of " + names())->required();
  command->add_option("--runs", options->runs, "runs of each case; default: as published")
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--seed", options->run.seed, "of all random numbers")->capture_default_str();
  command->add_option("--case", options->run.cases, "only this case; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--method", options->run.methods, "only this method; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--threads", options->run.threads, "the results do not depend on it")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_option("--json", options->json, "file for the rows as JSON; - for standard output");
  command->callback([options] {
    use_large_pages();
    run(*options);
  });
}

}  // namespace fathom::cli
