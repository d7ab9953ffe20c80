#include "cli/explain/explain.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/iso8601.hpp"
#include "cli/bus_options.hpp"
#include "cli/command.hpp"
#include "cli/explain/read.hpp"
#include "cli/large_pages.hpp"
#include "cli/recording.hpp"
#include "explain/account.hpp"

namespace fathom::cli {
namespace {

struct ExplainOptions {
  std::vector<std::string> files;
  std::string vehicle;
  std::string at;  ///< seconds, or UTC
  std::string alarm;
  double last_s = 0.0;
  bool live = false;
  double listen_s = 60.0;
  bus::ParticipantOptions bus;
  bool json = false;
};

explain::History read(const ExplainOptions& options, const ReadLive& read_live) {
  if (options.live) {
    LiveOptions live;
    live.bus = options.bus;
    live.vehicle = options.vehicle;
    if (options.last_s > 0.0) live.last_s = options.last_s;
    live.listen_s = options.listen_s;
    explain::History heard = read_live(live);
    if (heard.empty()) {
      throw Failure(ExitCode::no,
                    "explain --live: nothing that navigation or its instruments say came on domain " +
                        std::to_string(options.bus.domain) +
                        (options.vehicle.empty() ? "" : " from vehicle " + options.vehicle));
    }
    return heard;
  }
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

/// Of --at: an instant within the log.
TimeNs instant(const std::string& at, const explain::History& history) {
  const double length_s = to_seconds(history.to_ns() - history.from_ns());
  std::optional<TimeNs> out = from_iso8601(at);
  double seconds = 0.0;
  if (!out && CLI::detail::lexical_cast(at, seconds) && std::abs(seconds) < 1e9)
    out = history.from_ns() + from_seconds(seconds < 0.0 ? length_s + seconds : seconds);
  if (out && *out >= history.from_ns() && *out <= history.to_ns()) return *out;
  char text[240];
  std::snprintf(text, sizeof text,
                "--at %.40s: expected seconds within the log, which is %.1f s long, or UTC from %s to %s",
                at.c_str(), length_s, to_iso8601(history.from_ns()).c_str(),
                to_iso8601(history.to_ns()).c_str());
  throw Failure(ExitCode::bad_configuration, text);
}

explain::Question question(const ExplainOptions& options, const explain::History& history) {
  explain::Question out;
  if (!options.at.empty()) out.at_ns = instant(options.at, history);
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

void add_explain(CLI::App& app, ExitCode& exit_code, ReadLive read_live) {
  auto options = std::make_shared<ExplainOptions>();
  CLI::App* command = app.add_subcommand(
      "explain",
      "Says in sentences what happened, in a recording or on a running vehicle: the likely cause first, "
      "evidence, what to do.");
  command->footer(
      "It reads what the vehicle itself published: samples, navigation states, verdicts, alignment, alarms, "
      "life\nsigns; no truth. Times are UTC and seconds after the beginning of the log.\n\n"
      "Exit code 0 when nothing stands out, 1 when something is named, 2 for a wrong option, 3 when a file "
      "cannot\nbe read.");
  CLI::Option* files =
      command->add_option("file", options->files, "recording (.mcap); several that follow one another");
  CLI::Option* live = command->add_flag("--live", options->live,
                                        "of the running vehicle: the last ten minutes (--last) where a "
                                        "recorder runs on this computer, else what "
                                        "comes while it listens (--listen)");
  live->excludes(files);
  command->add_option("--listen", options->listen_s, "seconds; of --live without a recorder")
      ->needs(live)
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  CLI::Option* at = command->add_option(
      "--at", options->at,
      "only around this instant: seconds after the beginning; negative: before the end; or UTC, "
      "2026-01-31T12:00:00Z");
  command
      ->add_option("--alarm", options->alarm, "only what led to this alarm, e.g. gps_outage or refused:gps")
      ->excludes(at);
  command->add_option("--last", options->last_s, "only the last so many seconds of the log")
      ->check(CLI::Range(10.0, 1e9));
  command->add_option("--vehicle", options->vehicle,
                      "of this vehicle; without it: of the one that is heard first");
  command->add_flag("--json", options->json, "one JSON object: findings, alarms, instants");
  options->bus.name = "fathom_explain";
  options->bus.low_priority = true;
  add_bus_options(*command, options->bus, "recorder");
  command->callback([options, &exit_code, read_live = std::move(read_live)] {
    if (!options->live) use_large_pages();
    if (options->files.empty() && !options->live)
      throw Failure(ExitCode::bad_configuration, "explain: expected a recording (.mcap), or --live");
    const explain::History history = read(*options, read_live);
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
