#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/explain/read.hpp"
#include "cli/recording.hpp"
#include "explain/account.hpp"

namespace fathom::cli {
namespace {

struct ExplainOptions {
  std::vector<std::string> files;
  std::string vehicle;
  double at_s = 0.0;
  std::string alarm;
  double last_s = 0.0;
  bool has_at = false;
  bool json = false;
};

explain::History read(const ExplainOptions& options) {
  explain::History::Limits limits;
  if (options.last_s > 0.0) limits.span_ns = from_seconds(options.last_s);
  explain::History history(limits, Name(options.vehicle));
  for (const std::string& file : options.files) {
    record::Reader reader = open_recording(file);
    for (const std::string& problem : read_into(history, reader, {}))
      std::fprintf(stderr, "fathom: explain: %s: %s\n", file.c_str(), problem.c_str());
  }
  if (history.empty()) {
    throw Failure(ExitCode::bad_input,
                  options.files.front() + ": holds nothing that navigation or its instruments said" +
                      (options.vehicle.empty() ? "" : " of vehicle " + options.vehicle) +
                      ", expected topics fathom/v1/imu, fathom/v1/nav_state, fathom/v1/verdict and others");
  }
  return history;
}

explain::Question question(const ExplainOptions& options, const explain::History& history) {
  explain::Question out;
  if (options.has_at) {
    const double length_s = to_seconds(history.to_ns() - history.from_ns());
    const double at_s = options.at_s < 0.0 ? length_s + options.at_s : options.at_s;
    if (!(at_s >= 0.0) || at_s > length_s) {
      char text[160];
      std::snprintf(text, sizeof text, "--at %g: the log is %.1f s long, expected seconds within it",
                    options.at_s, length_s);
      throw Failure(ExitCode::bad_configuration, text);
    }
    out.at_ns = history.from_ns() + from_seconds(at_s);
  }
  if (options.alarm.empty()) return out;
  out.alarm = options.alarm;
  std::string known;
  for (const explain::AlarmRow& row : history.alarms()) {
    if (explain::is_of(row.alarm, options.alarm)) return out;
    const std::string name = row.alarm.alarm.str();
    if ((", " + known + ", ").find(", " + name + ", ") == std::string::npos)
      known += (known.empty() ? "" : ", ") + name;
  }
  throw Failure(ExitCode::bad_configuration,
                "--alarm " + options.alarm + ": not in the log, " +
                    (known.empty() ? "which has no alarms" : "expected one of: " + known));
}

}  // namespace

void add_explain(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<ExplainOptions>();
  CLI::App* command = app.add_subcommand(
      "explain",
      "Says in sentences what happened in a recording: the likely cause first, evidence, what to do.");
  command->footer(
      "It reads what the vehicle itself published: samples, navigation states, verdicts, alignment, alarms, "
      "life\nsigns; no truth. Times are UTC and seconds after the beginning of the log.\n\n"
      "Exit code 0 when nothing stands out, 1 when something is named, 2 for a wrong option, 3 when a file "
      "cannot\nbe read.");
  command->add_option("file", options->files, "recording (.mcap); several that follow one another")
      ->required();
  CLI::Option* at =
      command->add_option("--at", options->at_s,
                          "only around this instant: seconds after the beginning; negative: before the end");
  command
      ->add_option("--alarm", options->alarm, "only what led to this alarm, e.g. gps_outage or refused:gps")
      ->excludes(at);
  command->add_option("--last", options->last_s, "only the last so many seconds of the log")
      ->check(CLI::Range(10.0, 1e9));
  command->add_option("--vehicle", options->vehicle,
                      "of this vehicle; without it: of the one that is heard first");
  command->add_flag("--json", options->json, "one JSON object: findings, alarms, instants");
  command->callback([options, at, &exit_code] {
    options->has_at = at->count() > 0;
    const explain::History history = read(*options);
    const explain::Answer answer = explain::answer(history, question(*options, history));
    if (options->json) {
      std::printf("%s\n", explain::to_json(history, answer)
                              .dump(2, ' ', false, nlohmann::json::error_handler_t::replace)
                              .c_str());
    } else {
      std::printf("%s", explain::account(history, answer).c_str());
    }
    for (const std::size_t root : answer.roots)
      if (explain::named(answer.findings[root])) exit_code = ExitCode::no;
  });
}

}  // namespace fathom::cli
