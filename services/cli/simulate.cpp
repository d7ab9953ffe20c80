#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/outputs.hpp"
#include "cli/progress.hpp"
#include "cli/removed_files.hpp"
#include "config/scenario/scenario_config.hpp"
#include "dataset/dataset.hpp"
#include "sim/simulation.hpp"

namespace fathom::cli {
namespace {

struct SimulateOptions {
  std::string scenario;
  std::string out;
  std::vector<std::string> sets;
  std::uint64_t seed = 1;
  double duration_s = 0.0;
  double reference_hz = 20.0;
  bool gzip = false;
  bool json = false;
};

sim::Scenario load(const SimulateOptions& options) {
  return config::load_scenario({config::scenario_file(options.scenario), options.sets});
}

void keep(dataset::Dataset& data, const sim::Measurement& measurement) {
  std::visit([&]<class T>(const T& sample) { data.of<T>().push_back(sample); }, measurement);
}

dataset::Dataset run(const sim::Scenario& scenario, const SimulateOptions& options, double duration_s) {
  sim::Simulation::Options simulate;
  simulate.epoch_ns = dataset::kDefaultEpochNs;
  simulate.seed = options.seed;
  sim::Simulation simulation(scenario, simulate);
  dataset::Dataset data;
  std::vector<sim::Measurement> measurements;
  const double imu_hz = scenario.sensors.of<ImuSample>().rate_hz;
  const auto intervals = static_cast<std::uint64_t>(std::llround(duration_s * imu_hz));
  const auto every = static_cast<std::uint64_t>(std::max(1.0, std::round(imu_hz / options.reference_hz)));
  Progress progress("simulating " + scenario.name, intervals);
  data.reference.push_back(simulation.truth());
  for (std::uint64_t i = 1; i <= intervals; ++i) {
    measurements.clear();
    simulation.advance(measurements);
    for (const auto& measurement : measurements) keep(data, measurement);
    if (i % every == 0) data.reference.push_back(simulation.truth());
    progress.update(i);
  }
  return data;
}

void simulate(const SimulateOptions& options) {
  const sim::Scenario scenario = load(options);
  const double duration_s = options.duration_s > 0.0 ? options.duration_s : scenario.duration_s;
  const dataset::Dataset data = run(scenario, options, duration_s);
  dataset::WriteOptions write;
  write.gzip = options.gzip;
  const RemovedFiles removed(options.out);
  try {
    dataset::write(options.out, data, write);
  } catch (const dataset::DatasetError& error) {
    throw Failure(ExitCode::runtime_failure, error.what());
  }
  if (options.json) {
    nlohmann::ordered_json line = {
        {"scenario", scenario.name}, {"seed", options.seed}, {"duration_s", duration_s}};
    for_each_kind([&](auto kind) {
      line[std::string(kind.kWord)] = data.of<typename decltype(kind)::Sample>().size();
    });
    line["reference"] = data.reference.size();
    std::printf("%s\n", line.dump().c_str());
  } else {
    std::printf("%s: %.6g s of %s, seed %llu: %zu inertial samples, %zu reference rows\n",
                options.out.c_str(), duration_s, scenario.name.c_str(),
                static_cast<unsigned long long>(options.seed), data.of<ImuSample>().size(),
                data.reference.size());
  }
}

}  // namespace

void add_simulate(CLI::App& app, ExitCode&) {
  auto options = std::make_shared<SimulateOptions>();
  auto* command = app.add_subcommand("simulate",
                                     "Writes the data set of a simulated vehicle, reference included. "
                                     "The same seed gives the same bytes.");
  command->add_option("scenario", options->scenario, "name of a scenario, or its file")->required();
  command
      ->add_option("--out", options->out,
                   "folder to write; created when absent; files of an earlier data set there are removed")
      ->required();
  command->add_option("--seed", options->seed, "of all random numbers")->capture_default_str();
  command->add_option("--duration", options->duration_s, "seconds; default: as the scenario says")
      ->check(CLI::Range(0.01, 1e6));
  command->add_option("--reference-rate", options->reference_hz, "rows a second in reference.csv")
      ->check(CLI::Range(0.01, 2000.0))
      ->capture_default_str();
  command->add_option("--set", options->sets, "override of the scenario: key.sub=value, may be repeated")
      ->allow_extra_args(false);
  command->add_flag("--gzip", options->gzip, "write .csv.gz");
  command->add_flag("--json", options->json, "summary as JSON");
  command->callback([options] {
    refuse_same_files({{"the scenario", options->scenario}}, {{"--out", options->out, true}});
    simulate(*options);
  });
}

}  // namespace fathom::cli
