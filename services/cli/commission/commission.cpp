#include "commission/commission.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/commission/assume.hpp"
#include "cli/commission/page.hpp"
#include "cli/commission/patch.hpp"
#include "cli/large_pages.hpp"
#include "cli/log.hpp"
#include "cli/outputs.hpp"
#include "config/fusion/fusion_config.hpp"
#include "config/json/error.hpp"
#include "config/vehicle/vehicle_config.hpp"
#include "dataset/dataset.hpp"

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;

struct CommissionOptions {
  std::string log;
  std::string config;
  std::string vehicle;
  std::vector<std::string> sets;
  std::string page;
  bool json = false;
  bool apply = false;
};

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json json_of(const commission::Commissioning& found, const std::vector<Change>& changes) {
  Json out;
  out["findings"] = Json::array();
  for (const commission::Finding& finding : found.findings) {
    out["findings"].push_back({{"sensor", finding.sensor},
                               {"what", finding.what},
                               {"kind", to_string(finding.kind)},
                               {"value", number(finding.value)},
                               {"unit", finding.unit},
                               {"sigma", number(finding.sigma)},
                               {"known", finding.known},
                               {"severity", to_string(finding.severity)},
                               {"text", finding.text}});
  }
  out["duration_s"] = found.duration_s;
  out["rest_s"] = found.rest_s;
  out["patch"] = Json::object();
  for (const Change& change : changes) out["patch"][change.key] = change.value;
  return out;
}

void print(const commission::Commissioning& found) {
  const auto group = [&](const char* title, auto&& belongs) {
    bool first = true;
    for (const commission::Finding& finding : found.findings) {
      if (!belongs(finding)) continue;
      if (first) std::printf("%s\n", title);
      first = false;
      std::printf("  %-8s %s\n", finding.sensor.c_str(), finding.text.c_str());
    }
  };
  std::printf("%.0f s of log, %.0f s of it at rest in one piece.\n", found.duration_s, found.rest_s);
  group("WRONG", [](const commission::Finding& f) { return f.severity == commission::Severity::wrong; });
  group("To look at", [](const commission::Finding& f) { return f.severity == commission::Severity::note; });
  group("As it should be",
        [](const commission::Finding& f) { return f.severity == commission::Severity::ok && f.known; });
  group("What the log cannot tell",
        [](const commission::Finding& f) { return f.severity != commission::Severity::wrong && !f.known; });
}

// Written beside the old one and checked before it takes its place.
void replace_file(const std::string& path, const Json& config, bool vehicle) {
  const std::string beside = path + ".commissioned";
  write_text(beside, config.dump(2) + "\n");
  try {
    if (vehicle) {
      config::vehicle_kind().check({beside, {}});
    } else {
      (void)config::load_service_config<config::FusionConfig>({beside, {}});
    }
  } catch (const config::ConfigError& error) {
    std::filesystem::remove(beside);
    throw Failure(ExitCode::runtime_failure,
                  path + ": the corrected configuration would not load, the old one stays: " + error.what());
  }
  std::error_code error;
  std::filesystem::rename(beside, path, error);
  if (error) throw Failure(ExitCode::runtime_failure, path + ": cannot be replaced: " + error.message());
}

ExitCode run_commission(const CommissionOptions& options) {
  const bool of_vehicle = !options.vehicle.empty();
  const std::string& corrected = of_vehicle ? options.vehicle : options.config;
  if (of_vehicle && !options.config.empty())
    throw Failure(
        ExitCode::bad_configuration,
        "commission: --vehicle and --config are both given, expected one: the file that is corrected");
  if (options.apply && corrected.empty())
    throw Failure(ExitCode::bad_configuration,
                  "commission: --apply needs --vehicle or --config: the file that it corrects");
  commission::Assumed assumed;
  Json config = Json::object();
  dataset::Dataset data;
  if (!corrected.empty() || is_recording(options.log)) {
    const config::LoadedConfig<config::FusionConfig> loaded =
        of_vehicle ? config::load_service_config<config::FusionConfig>(
                         config::with_vehicle({"", options.sets}, options.vehicle, "fusion"))
                   : configuration_for(options.log, {"", options.config}, options.sets);
    assumed = assumed_by(loaded.value);
    data = read_log(options.log, loaded.value);
    if (!corrected.empty()) {
      std::ifstream file(corrected, std::ios::binary);
      config = Json::parse(file);
    }
  } else {
    if (!options.sets.empty())
      throw Failure(ExitCode::bad_configuration,
                    "commission: --set needs --vehicle or --config: the configuration that it overrides");
    data = read_dataset(options.log, "auv");
    refuse_without_imu_file(options.log);
  }
  const auto& imu = data.of<ImuSample>();
  if (imu.size() < 100 || imu.back().header.stamp_ns - imu.front().header.stamp_ns < 5 * kNsPerSecond)
    throw Failure(ExitCode::bad_input,
                  options.log + "/imu.csv: " + std::to_string(imu.size()) +
                      " inertial samples, expected at least a hundred over five seconds");
  const commission::Commissioning found = commission::commission(data, assumed);
  const std::vector<Change> changes = corrected.empty() ? std::vector<Change>{}
                                      : of_vehicle      ? vehicle_changes_of(found.patch, config)
                                                        : changes_of(found.patch, config);
  if (options.json) {
    std::printf("%s\n", json_of(found, changes).dump().c_str());
  } else {
    print(found);
    if (!changes.empty())
      std::printf("%s\n", options.apply ? "Changed in the configuration"
                                        : "The configuration should say (--apply writes it)");
    for (const Change& change : changes)
      std::printf("  %s: %s (was %s)\n", change.key.c_str(), change.value.dump().c_str(),
                  change.was.is_null() ? "not set" : change.was.dump().c_str());
  }
  if (!options.page.empty()) write_text(options.page, page_of(found, options.log));
  if (options.apply && !changes.empty()) replace_file(corrected, patched(config, changes), of_vehicle);
  return commission::any_wrong(found.findings) ? ExitCode::no : ExitCode::done;
}

}  // namespace

void add_commission(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<CommissionOptions>();
  CLI::App* command = app.add_subcommand(
      "commission",
      "What a log tells about the instruments: axes, units, mounting, levers, latencies, noise.");
  command->footer(
      "The log: some twenty minutes with five minutes at rest, starts and stops, turns to both sides and, "
      "under\n"
      "water, dives. What it cannot tell is said, with the manoeuvre that would. Exit code 1 when something "
      "is\n"
      "wrong. The data set: common/dataset/README.md.");
  command
      ->add_option("log", options->log,
                   "data set: a folder with imu.csv and others, plain or .gz; or a recording (.mcap)")
      ->required();
  command->add_option("--config", options->config,
                      "configuration of fusion that the log is held against; without one: that of a "
                      "recording, else nothing is "
                      "turned or late");
  command->add_option("--vehicle", options->vehicle,
                      "file of the vehicle that the log is held against, in place of --config");
  command->add_option("--set", options->sets, "override of the configuration: key.sub=value, may be repeated")
      ->allow_extra_args(false);
  command->add_flag("--json", options->json, "findings as JSON");
  command->add_option("--page", options->page, "write a page of HTML with plots, complete in itself");
  command->add_flag("--apply", options->apply, "write what was found into the file of --vehicle or --config");
  command->callback([options, &exit_code] {
    use_large_pages();
    refuse_same_files(
        {{"the input", options->log, true}, {"--config", options->config}, {"--vehicle", options->vehicle}},
        {{"--page", options->page}});
    exit_code = run_commission(*options);
  });
}

}  // namespace fathom::cli
