#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/command.hpp"
#include "cli/large_pages.hpp"
#include "cli/log.hpp"
#include "cli/outputs.hpp"
#include "cli/report/gather.hpp"
#include "cli/report/recorded.hpp"
#include "cli/solve/outage.hpp"
#include "cli/solve/run.hpp"
#include "report/material.hpp"
#include "runtime/build_info.hpp"

namespace fathom::cli {
namespace {

struct ReportOptions {
  std::string directory;
  ConfigFiles config;
  std::vector<std::string> sets;
  std::string out;
  std::string outages;
  std::string start;
};

report::Material make(const ReportOptions& options) {
  const config::LoadedConfig<config::FusionConfig> loaded =
      configuration_for(options.directory, options.config, options.sets);
  const dataset::Dataset data = read_log(options.directory, loaded.value);
  const TimeNs epoch_ns = time_zero_of(options.directory, data);
  const std::vector<dataset::Arrival> arrivals = dataset::arrivals(data);
  SolveRun solve_run;
  solve_run.config = &loaded.value;
  solve_run.data = &data;
  solve_run.arrivals = &arrivals;
  solve_run.label = "report";
  if (options.start == "reference")
    solve_run.start = start_from_reference(data, loaded.value, options.directory);
  if (!options.outages.empty()) {
    solve_run.gps_removed = first_windows(data, parse_outages(options.outages), epoch_ns, options.directory);
  }
  report::Material material = gather(solve_run, epoch_ns);
  const std::filesystem::path folder = std::filesystem::path(options.directory).lexically_normal();
  material.title =
      "Navigation of " + (folder.has_filename() ? folder : folder.parent_path()).filename().string();
  material.source = options.directory;
  material.config = options.config.text();
  material.config_hash = loaded.hash;
  material.version = "fathom " + std::string(runtime::version());
  if (is_recording(options.directory))
    add_recorded(options.directory, loaded.value.common.vehicle, epoch_ns, material);
  return material;
}

}  // namespace

void add_report(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand(
      "report",
      "Runs a data set or a recording through the fusion engine and writes one HTML page about the run.");
  command->footer(
      "The page says first what to look at, then shows the track, errors against reference.csv where there "
      "is\n"
      "one, sigmas, innovations, outages with their forecasts, and alignment; of a recording also what the "
      "vehicle\nitself tells, services and clocks. It needs nothing from elsewhere,\n"
      "and is readable by day, by night and on paper.");
  command->add_option("directory", options->directory, "data set, or a recording (.mcap), as of fathom solve")
      ->required();
  command->add_option("--vehicle", options->config.vehicle,
                      "file of the vehicle: fusion as it would run there");
  command->add_option("--config", options->config.own,
                      "configuration of the fusion service; of a recording without it: its own");
  command->add_option("--set", options->sets, "override: key.sub=value, may be repeated")
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "the page (HTML)")->required();
  command->add_option("--gps-outage", options->outages,
                      "remove GPS as fathom solve does, to see forecasts against what came");
  command->add_option("--start", options->start, "\"reference\": from the first row of reference.csv")
      ->check(CLI::IsMember({"reference"}));
  command->callback([options, &exit_code] {
    use_large_pages();
    refuse_same_files({{"the input", options->directory, true},
                       {"--vehicle", options->config.vehicle},
                       {"--config", options->config.own}},
                      {{"--out", options->out}});
    const report::Material material = make(*options);
    write_text(options->out, report::page(material));
    bool any = false;
    for (const report::StateRow& row : material.states) any = any || known(row.latitude_rad);
    for (const report::Finding& one : report::findings(material)) std::printf("%s\n", one.text.c_str());
    if (!any) exit_code = ExitCode::no;
  });
}

}  // namespace fathom::cli
