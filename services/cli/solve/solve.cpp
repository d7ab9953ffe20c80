#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/command.hpp"
#include "cli/large_pages.hpp"
#include "cli/log.hpp"
#include "cli/outputs.hpp"
#include "cli/solve/calibrate.hpp"
#include "cli/solve/compare/compare.hpp"
#include "cli/solve/course.hpp"
#include "cli/solve/fixes.hpp"
#include "cli/solve/metrics.hpp"
#include "cli/solve/outage.hpp"
#include "cli/solve/run.hpp"
#include "cli/solve/smooth.hpp"
#include "config/fusion/fusion_config.hpp"
#include "dataset/dataset.hpp"
#include "dataset/instants.hpp"
#include "dataset/nav_csv.hpp"
#include "dataset/score.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "report/comparison.hpp"
#include "runtime/build_info.hpp"
#include "samples/alignment/help.hpp"
#include "samples/position/gives_position.hpp"

namespace fathom::cli {
namespace {

struct SolveOptions {
  std::string directory;
  ConfigFiles config;
  std::vector<std::string> sets;
  std::string out;
  std::string metrics;
  std::string outages;
  std::string start;
  std::string calibrate_hydro;
  std::vector<std::string> without;
  std::string compare_config;
  std::string compare_csv;
  std::string compare_page;
  std::string at;
  double rate_hz = 0.0;
  bool smooth = false;
  bool json = false;
};

// Passes every n-th state so that rows come at a steady rate; all of them at rate 0.
class Thinning {
 public:
  explicit Thinning(double rate_hz) : period_ns_(rate_hz > 0.0 ? from_seconds(1.0 / rate_hz) : 0) {}
  bool pass(TimeNs stamp_ns) {
    if (period_ns_ == 0) return true;
    if (next_ns_ && stamp_ns < *next_ns_) return false;
    const TimeNs due_ns = next_ns_.value_or(stamp_ns);
    // The grid stays where it began; a gap does not cause a burst behind it.
    next_ns_ = due_ns + period_ns_ * ((stamp_ns - due_ns) / period_ns_ + 1);
    return true;
  }

 private:
  DurationNs period_ns_;
  std::optional<TimeNs> next_ns_;
};

std::vector<dataset::Instant> read_instants(const std::string& file, TimeNs epoch_ns) {
  try {
    return dataset::read_instants(file, epoch_ns);
  } catch (const dataset::DatasetError& error) {
    throw Failure(ExitCode::bad_input, error.what());
  }
}

// Throws Failure where an instant has no state: the file lacks its row.
void say_refused(const dataset::AtInstants& at, const std::string& file, TimeNs epoch_ns) {
  const std::vector<dataset::Instant> refused = at.refused();
  if (refused.empty()) return;
  const auto seconds = [epoch_ns](TimeNs stamp_ns) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.6f s", to_seconds(stamp_ns - epoch_ns));
    return std::string(text.data());
  };
  std::string message = file + ":" + std::to_string(refused.front().line) + ": " +
                        seconds(refused.front().stamp_ns) + " has no solution, expected an instant ";
  message += at.first_ns() ? "from " + seconds(*at.first_ns()) + " to " + seconds(*at.last_ns()) +
                                 ", where no more than a second is between two states"
                           : "at which there is a position, and there is none at all";
  if (refused.size() > 1) {
    message += "; likewise " + std::to_string(refused.size() - 1) + " more, the last in line " +
               std::to_string(refused.back().line);
  }
  throw Failure(ExitCode::bad_input, message + "; the other rows are written");
}

// What a person gave, in one line.
std::string settings_text(const ConfigFiles& config, const std::vector<std::string>& sets,
                          const std::vector<std::string>& without) {
  std::string out = config.text();
  for (const std::string& set : sets) out += " --set " + set;
  for (const std::string& one : without) out += " --without " + one;
  return out;
}

/// What a data set may have besides imu.csv, for people.
std::string other_files() {
  std::string out;
  for_each_kind([&](auto kind) {
    if (kind.kSource != SourceKind::imu) out += std::string(kind.kWord) + ", ";
  });
  return out + "reference";
}

report::Comparison compare(const SolveOptions& options) {
  const ConfigFiles second_config =
      options.compare_config.empty() ? options.config : ConfigFiles{"", options.compare_config};
  const auto first = configuration_for(options.directory, options.config, {});
  const auto second = configuration_for(options.directory, second_config, options.sets);
  const dataset::Dataset data = read_log(options.directory, first.value);
  const TimeNs epoch_ns = time_zero_of(options.directory, data);
  const std::vector<dataset::Arrival> arrivals = dataset::arrivals(data);
  SolveRun one;
  one.config = &first.value;
  one.data = &data;
  one.arrivals = &arrivals;
  if (options.start == "reference") one.start = start_from_reference(data, first.value, options.directory);
  SolveRun other = one;
  other.config = &second.value;
  if (options.start == "reference") other.start = start_from_reference(data, second.value, options.directory);
  for (const std::string& text : options.without)
    other.withheld.push_back(parse_without(text, data, epoch_ns));
  std::optional<CompareCsv> csv;
  if (!options.compare_csv.empty()) csv.emplace(options.compare_csv);
  Thinning rows(options.rate_hz);
  CompareRequest request{&one, &other, epoch_ns, nullptr};
  if (csv) {
    request.on_row = [&](const report::ComparedRow& row) {
      if (known(row.difference.horizontal_m) && rows.pass(epoch_ns + from_seconds(row.t_s))) csv->add(row);
    };
  }
  report::Comparison out = compare(request);
  if (csv) csv->close();
  const std::filesystem::path name = std::filesystem::path(options.directory).lexically_normal();
  out.title = "Two solutions of " + (name.has_filename() ? name : name.parent_path()).filename().string();
  out.source = options.directory;
  out.version = "fathom " + std::string(runtime::version());
  out.solutions[0].settings = settings_text(options.config, {}, {});
  out.solutions[1].settings = settings_text(second_config, options.sets, options.without);
  out.solutions[0].config_hash = first.hash;
  out.solutions[1].config_hash = second.hash;
  return out;
}

SolveReport solve(const SolveOptions& options) {
  std::optional<OutageRequest> outages;
  if (!options.outages.empty()) outages = parse_outages(options.outages);

  const config::LoadedConfig<config::FusionConfig> loaded =
      configuration_for(options.directory, options.config, options.sets);
  const dataset::Dataset data = read_log(options.directory, loaded.value);
  const TimeNs epoch_ns = time_zero_of(options.directory, data);
  const std::vector<dataset::Arrival> arrivals = dataset::arrivals(data);

  SolveRun solve_run;
  solve_run.config = &loaded.value;
  solve_run.data = &data;
  solve_run.arrivals = &arrivals;
  solve_run.label = "solve";
  for (const std::string& text : options.without)
    solve_run.withheld.push_back(parse_without(text, data, epoch_ns));
  if (options.start == "reference")
    solve_run.start = start_from_reference(data, loaded.value, options.directory);
  if (outages) {
    solve_run.gps_removed = first_windows(data, *outages, epoch_ns, options.directory);
  }

  const dataset::TruthTrack truth(data.reference);
  ReferencePlacement placement;
  const auto score = [](const NavState& state, const Truth& at, dataset::Scorer& scorer,
                        ReferencePlacement* place) {
    if (!gives_position(state.mode)) return;
    const dataset::NavError error = dataset::error_of(state, at);
    scorer.add(error);
    if (place != nullptr) place->add(state, error);
  };
  dataset::Scorer scorer;
  std::optional<dataset::AtInstants> at;
  if (!options.at.empty()) at.emplace(read_instants(options.at, epoch_ns));
  if (!options.calibrate_hydro.empty())
    check_calibration(solve_run, options.directory, options.config.text());
  dataset::NavCsv csv(options.out, epoch_ns);  // once all that is read is found to be good
  Thinning rows(options.rate_hz);
  SolveReport report;
  Path path;
  Path filtered_path;
  const std::size_t most_states = data.of<ImuSample>().size();
  if (!data.reference.empty()) {
    scorer.reserve(most_states);
    placement.reserve(most_states);
  }
  if (!data.of<GpsSample>().empty()) path.reserve(most_states);
  HeadingErrors heading_errors;
  const auto take = [&](const NavState& state) {
    report.alignment = state.alignment;
    // The file begins with the first position.
    if (!known(state.latitude_rad)) return;
    ++report.positions;
    if (at) {
      at->add(state, [&csv](const NavState& one) { csv.add(one); });
    } else if (rows.pass(state.header.stamp_ns)) {
      csv.add(state);
    }
    if (const auto reference = truth.at(state.header.stamp_ns)) {
      score(state, *reference, scorer, &placement);
      add_heading(state, *reference, heading_errors);
    }
    if (!data.of<GpsSample>().empty()) path.add(state);
  };

  report.dataset = options.directory;
  report.config = options.config.none() ? "" : options.config.text();
  report.config_hash = loaded.hash;
  report.start = solve_run.start ? "reference" : "configured";
  report.smoothed = options.smooth;
  if (options.smooth) {
    dataset::Scorer filtered;
    const auto take_filtered = [&](const NavState& state) {
      if (const auto reference = truth.at(state.header.stamp_ns)) score(state, *reference, filtered, nullptr);
      if (!data.of<GpsSample>().empty()) filtered_path.add(state);
    };
    report.result = run_smoothed(solve_run, {take_filtered, take});
    report.filtered = filtered.score();
  } else {
    HeadingWatch heading(loaded.value, data.of<GpsSample>());
    NavDetail detail;
    solve_run.on_state = [&](const NavState& state, const estimation::FusionEngine& engine) {
      take(state);
      if (heading.wants_detail(state)) engine.fill(detail);
      heading.add(state, detail);
    };
    report.result = run(solve_run);
    solve_run.on_state = {};
    report.heading = heading.figures();
    report.heading.reference = heading_errors;
  }
  csv.close();
  if (at) say_refused(*at, options.at, epoch_ns);
  report.score = scorer.score();
  report.placement = placement.figures();
  if (report.score.count > 0)
    report.distance_m = truth.distance_m(report.score.first_ns, report.score.last_ns);
  const Antenna antenna = antenna_of(loaded.value, report.result.gps_latency_s);
  for (const GpsSample& fix : data.of<GpsSample>()) {
    if (fix.fix == GpsFix::none || solve_run.withholds(fix)) continue;
    report.at_fixes.add(path.error_m(fix, antenna));
    if (options.smooth) report.filtered_at_fixes.add(filtered_path.error_m(fix, antenna));
  }
  if (outages) {
    report.outages = run_outages(solve_run, *outages, options.smooth, epoch_ns, options.directory);
  }
  if (!options.calibrate_hydro.empty())
    report.calibration = calibrate_hydro(solve_run, options.directory, options.calibrate_hydro);
  return report;
}

}  // namespace

void add_solve(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<SolveOptions>();
  CLI::App* command =
      app.add_subcommand("solve", "Run a recorded data set through the fusion engine, offline.");
  command->footer(
      "The data set: imu.csv (t_s, gx_rad_s gy_rad_s gz_rad_s, ax_m_s2 ay_m_s2 az_m_s2, body axes forward, "
      "right,\n"
      "down) and any of " +
      other_files() +
      " (.csv or .csv.gz),\n"
      "each with t_s in seconds. Their columns: common/dataset/README.md of the documents\n"
      "(/usr/share/doc/fathom); one that is missing is named. Configurations to begin from: "
      "deploy/config/fusion.json, "
      "deploy/config/solve/*.json.");
  command
      ->add_option("directory", options->directory,
                   "data set: a folder with imu.csv and others, plain or .gz; or a recording, FILE.mcap")
      ->required();
  command->add_option("--vehicle", options->config.vehicle,
                      "file of the vehicle: fusion as it would run there; --config goes over it");
  command->add_option("--config", options->config.own,
                      "configuration of the fusion service; of a recording: default as it was recorded");
  command->add_option("--set", options->sets, "override: key.sub=value, may be repeated")
      ->allow_extra_args(false);
  CLI::Option* out =
      command->add_option("--out", options->out,
                          "navigation solution (CSV); compressed when the name ends in .gz; required without "
                          "--compare");
  CLI::Option* metrics = command->add_option(
      "--metrics", options->metrics, "errors against the reference, consistency, verdicts, timing (JSON)");
  CLI::Option* outages = command->add_option(
      "--gps-outage", options->outages,
      "T1,T2,...[@start[:recover]] or random:N[@start]: remove GPS for T s at a time from `start` on "
      "(seconds of the data "
      "set; default 60 s after motion begins), with `recover` s of GPS in between (default 40), and "
      "compare with the removed fixes, pooled over start, +13, +26 and +39 s; the solution written is "
      "that of the first duration and start; random: N windows of 5 to 60 s");
  command->add_option("--start", options->start, "\"reference\": from the first row of reference.csv")
      ->check(CLI::IsMember({"reference"}));
  CLI::Option* rate = command
                          ->add_option("--rate", options->rate_hz,
                                       "rows per second of the solution; one per inertial sample otherwise")
                          ->check(CLI::Range(1e-3, 1e5));
  CLI::Option* at =
      command
          ->add_option("--at", options->at,
                       "a file with one instant a line, in seconds of the data set: one row of the solution "
                       "for each of them instead of --rate. Position and velocity go straight between two "
                       "states, attitude takes the shortest turn, sigmas are those of the nearer state")
          ->excludes(rate);
  CLI::Option* smooth = command->add_flag(
      "--smooth", options->smooth,
      "every state from all measurements before and after it: filter forward, each measurement at its own "
      "instant, then backward");
  CLI::Option* hydro = command->add_option(
      "--calibrate-hydro", options->calibrate_hydro,
      "fit the coefficients of the configured vehicle model to the velocities that the DVL "
      "gave and write them, each with its sigma (JSON)");
  command
      ->add_option(
          "--without", options->without,
          "leave out a source, SOURCE or SOURCE@FROM:TO in seconds of the data set: gps@100:160; may "
          "be repeated")
      ->allow_extra_args(false);
  CLI::Option* other =
      command
          ->add_option("--compare", options->compare_config,
                       "solve twice and show both side by side: first as configured, second with this file "
                       "instead of --vehicle and --config, and with --set and --without; errors are against "
                       "the reference or, "
                       "without one, against the smoother")
          ->expected(0, 1)
          ->excludes(out)
          ->excludes(at)
          ->excludes(metrics)
          ->excludes(outages)
          ->excludes(smooth)
          ->excludes(hydro);
  command
      ->add_option("--csv", options->compare_csv,
                   "of --compare: differences, sigmas and errors over time (CSV), at --rate")
      ->needs(other);
  command->add_option("--page", options->compare_page, "of --compare: one page (HTML)")->needs(other);
  command->add_flag("--json", options->json, "print the metrics, or the comparison, as JSON");
  command->callback([options, other, out, &exit_code] {
    use_large_pages();
    refuse_same_files({{"the input", options->directory, true},
                       {"--vehicle", options->config.vehicle},
                       {"--config", options->config.own},
                       {"--compare", options->compare_config},
                       {"--at", options->at}},
                      {{"--out", options->out},
                       {"--metrics", options->metrics},
                       {"--calibrate-hydro", options->calibrate_hydro},
                       {"--csv", options->compare_csv},
                       {"--page", options->compare_page}});
    if (other->count() > 0) {
      const report::Comparison comparison = compare(*options);
      if (!options->compare_page.empty()) write_text(options->compare_page, report::page(comparison));
      std::fputs((options->json ? to_json(comparison) : to_text(comparison)).c_str(), stdout);
      if (comparison.compared == 0) exit_code = ExitCode::no;
      return;
    }
    if (out->count() == 0)
      throw Failure(ExitCode::bad_configuration, "--out is required without --compare; see --help");
    const SolveReport report = solve(*options);
    if (!options->metrics.empty()) write_text(options->metrics, to_json(report));
    std::fputs((options->json ? to_json(report) : to_text(report)).c_str(), stdout);
    if (!options->json) std::fputs(report.calibration.c_str(), stdout);
    const bool refused =
        implausible(report.result.alignment) != nullptr && report.alignment != AlignmentPhase::aligned;
    if (report.positions == 0 || refused) exit_code = ExitCode::no;
  });
}

}  // namespace fathom::cli
