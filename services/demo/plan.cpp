#include "demo/plan.hpp"

#include <algorithm>
#include <fstream>
#include <random>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/clock.hpp"
#include "config/console_config.hpp"
#include "config/monitor_config.hpp"
#include "config/scenario/scenario_config.hpp"
#include "config/scenario/scenario_wiring.hpp"
#include "config/service_config.hpp"
#include "config/vehicle/vehicle_config.hpp"
#include "dataset/dataset.hpp"
#include "demo/recording.hpp"
#include "demo/vehicle.hpp"
#include "launch/executable.hpp"
#include "security/keygen.hpp"

namespace fathom::demo {
namespace {

using nlohmann::json;
using Sets = std::vector<std::string>;

// Serial number of the demonstration's own network ports: two domains, two demonstrations side by side.
constexpr int kPortsPerDomain = 16;

// Of the monitor's metrics, plus the domain: demonstrations side by side do not meet.
constexpr int kMetricsPort = 9464;

// Host seconds that services get to find each other before a recording is played.
constexpr double kStartUpS = 8.0;

struct Places {
  std::filesystem::path executables;
  std::filesystem::path config;
};

Places find_places() {
  // The scenarios are found beside the executable or where installed; the services' files lie one folder up.
  return {launch::executables_folder(), std::filesystem::path(config::scenario_directory()).parent_path()};
}

std::string random_token() {
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::random_device random;
  std::string token;
  for (int i = 0; i < 32; ++i) token += kDigits[random() % kDigits.size()];
  return token;
}

/// Credentials of this run. Nobody will renew them: the authorities' keys are not kept.
std::string make_credentials(int domain, const std::filesystem::path& run_directory) {
  security::KeygenOptions options;
  options.folder = (run_directory / "credentials").string();
  options.domains = {static_cast<std::uint32_t>(domain), static_cast<std::uint32_t>(domain)};
  options.days = 60;  // longer than what services warn of
  security::make_credentials(options, SystemClock().utc_ns());
  std::filesystem::remove_all(security::CredentialFolder(options.folder).authority());
  return options.folder;
}

/// A file that nobody else may read.
void write_private(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path).flush();
  std::filesystem::permissions(path,
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  std::ofstream(path) << text;
}

class Builder {
 public:
  Builder(const Options& options, const std::filesystem::path& run_directory, Plan& plan)
      : places_(find_places()), plan_(plan), vehicle_(run_directory / "vehicle.json") {
    // Said on the command line as well: whoever looks for the processes of a run finds them by it.
    common_.push_back("bus.domain=" + std::to_string(options.domain));
    network_ = {{"domain", options.domain}, {"interfaces", options.interfaces}, {"peers", options.peers}};
    if (!plan.credentials.empty()) network_["security"] = {{"folder", plan.credentials}};
    common_.push_back("clock.anchor_file=" + (run_directory / "clock").string());
    if (options.speed != 1.0) {
      plan.epoch_ns = SystemClock().utc_ns();
      common_.push_back("clock.rate=" + json(options.speed).dump());
      common_.push_back("clock.epoch_ns=" + std::to_string(plan.epoch_ns));
    }
  }

  /// Writes the file that every service reads. Every bridge and service that the monitor is to miss is known.
  void write_vehicle(const sim::Scenario& scenario, const config::Wiring& wiring,
                     const std::vector<std::string>& bridges, bool standby, const Sets& expected) {
    json common = json::parse(std::ifstream(places_.config / "demo" / "vehicle.json"));
    common["$schema"] = (places_.config / "schema" / "vehicle.schema.json").string();
    std::ofstream out(vehicle_);
    out << vehicle_of(std::move(common), scenario, wiring, {network_, bridges, standby, expected}).dump(2)
        << "\n";
    if (!out.flush()) throw std::runtime_error(vehicle_.string() + ": cannot be written");
  }
  [[nodiscard]] const std::filesystem::path& vehicle() const { return vehicle_; }

  void add(const std::string& service, const Sets& sets, const std::filesystem::path& configuration = {}) {
    add_instance(service, service, sets, configuration);
  }

  /// One of several services of a kind, by a name of its own. With a configuration of its own it has nothing
  /// of the vehicle's but the network.
  void add_instance(const std::string& name, const std::string& service, const Sets& sets,
                    const std::filesystem::path& configuration = {}) {
    launch::Program program{name, places_.executables / launch::executable_of(service), {}, false};
    if (configuration.empty())
      program.arguments = {"--vehicle", vehicle_.string()};
    else
      program.arguments = {"--config", configuration.string()};
    const auto append = [&program](const Sets& list) {
      for (const std::string& set : list) {
        program.arguments.emplace_back("--set");
        program.arguments.push_back(set);
      }
    };
    if (!configuration.empty()) {
      for (const auto& [key, value] : network_.items())
        append({key == "security" ? "bus.security.folder=" + plan_.credentials
                                  : "bus." + key + "=" + value.dump()});
    }
    append(common_);
    append(sets);
    plan_.programs.push_back(std::move(program));
    plan_.demands.services.push_back(name);
  }

  /// Fusion, twice where the second one is to stand by. One that dies goes on from its checkpoint, or from
  /// what the other one knows, when it is started again.
  void add_fusion(Sets sets, const std::filesystem::path& configuration, bool standby,
                  const std::filesystem::path& run_directory) {
    sets.emplace_back("checkpoint.period_s=0.2");
    if (standby && !configuration.empty()) sets.emplace_back("standby.enabled=true");
    const auto add_one = [&](const std::string& name, int strength) {
      Sets own = sets;
      own.push_back("checkpoint.path=" + (run_directory / (name + ".checkpoint")).string());
      if (standby) {
        own.push_back("instance=" + name);
        if (!plan_.credentials.empty()) own.emplace_back("bus.security.identity=fusion");
        if (!configuration.empty()) own.push_back("ownership_strength=" + std::to_string(strength));
      }
      add_instance(name, "fusion", own, configuration);
    };
    add_one("fusion", 10);
    if (standby) add_one("fusion_standby", 5);
  }

  /// The operator console, where this build has one. Nothing of the run depends on it.
  void add_console(int domain, const std::filesystem::path& run_directory) {
    if (!std::filesystem::exists(places_.executables / "fathom-console")) return;
    const std::string token = random_token();
    const auto file = run_directory / "console_tokens.json";
    write_private(file,
                  json({{"tokens", {{{"name", "demo"}, {"role", "operator"}, {"token", token}}}}}).dump());
    const int port = config::kFirstConsolePort + domain;
    add("console",
        {"access.orders=true", "access.token_file=" + file.string(), "http.port=" + std::to_string(port)});
    plan_.programs.back().optional = true;
    plan_.demands.services.pop_back();
    plan_.console = "http://127.0.0.1:" + std::to_string(port) + "/#token=" + token;
  }

  [[nodiscard]] const Places& places() const { return places_; }

 private:
  Places places_;
  Plan& plan_;
  std::filesystem::path vehicle_;
  json network_;
  Sets common_;
};

// What the scenario says of a service beyond its vehicle. Files that it names lie beside those of the
// services.
Sets overrides_of(const sim::Scenario& scenario, const std::string& service,
                  const std::filesystem::path& config) {
  Sets out;
  const auto at = scenario.services.find(service);
  if (at == scenario.services.end()) return out;
  for (const auto& [key, value] : at->second)
    out.push_back(key + "=" + (key.ends_with("coefficients_file") ? (config / value).string() : value));
  return out;
}

std::filesystem::path recordings_folder(const Options& options) {
  if (!options.recordings.empty()) return std::filesystem::absolute(options.recordings);
  return std::filesystem::temp_directory_path() / ("fathom-recordings-" + std::to_string(getuid())) /
         std::to_string(options.domain);
}

}  // namespace

Plan make_plan(const Options& options, const std::filesystem::path& run_directory) {
  Plan plan;
  if (options.secure) plan.credentials = make_credentials(options.domain, run_directory);
  Builder builder(options, run_directory, plan);
  // A recorded vehicle's instruments get the devices of the survey scenario.
  const std::string scenario_file = std::filesystem::absolute(config::scenario_file(options.scenario));
  sim::Scenario scenario = config::load_scenario({scenario_file, {}});
  const config::Wiring wiring{(run_directory / "devices").string(), options.domain * kPortsPerDomain};
  Sets simulator{"scenario=" + scenario_file, "link_dir=" + wiring.link_dir,
                 "port_offset=" + std::to_string(wiring.port_offset)};
  Sets fusion;
  std::filesystem::path fusion_file;
  std::vector<std::string> bridges = scenario.bridges;

  if (options.dataset.empty()) {
    plan.title = scenario.name;
    plan.duration_s = options.duration_s > 0.0 ? options.duration_s : scenario.duration_s;
    plan.demands.limits = scenario.limits;
    plan.demands.whole_run = plan.duration_s >= scenario.duration_s;
  } else {
    const Recording recording = describe_recording(options.dataset, options.config, builder.places().config);
    scenario.services.clear();
    for_each_kind([&](auto kind) {
      double& rate_hz = scenario.sensors.of<typename decltype(kind)::Sample>().rate_hz;
      rate_hz = recording.rate_hz(kind.kWord, rate_hz);
    });
    scenario.sensors.of<ImuSample>().rate_hz = recording.imu_rate_hz;
    plan.title = std::filesystem::path(options.dataset).lexically_normal().string();
    plan.duration_s = options.duration_s > 0.0 ? options.duration_s : recording.duration_s;
    plan.demands.limits = {};
    // What the recorded instruments did is not known beforehand; what the services do is judged.
    plan.demands.expected_alarms = {"gps_*",         "sensor_*",       "refused:*",     "duplicate_stamps:*",
                                    "clock_*",       "device_clock:*", "nav_uncertain", "not_aligned",
                                    "alignment_lost"};
    plan.demands.limits.horizontal_rms_m = kUnknown;
    plan.demands.end_error_share = recording.end_error_limit;
    plan.demands.gps_expected = recording.has("gps");
    bridges = recording.bridges;
    fusion_file = recording.fusion_file;
    // The recording begins when every service has had time to come up; fusion starts from the reference
    // there.
    const TimeNs now_ns = plan.epoch_ns != 0 ? plan.epoch_ns : SystemClock().utc_ns();
    const TimeNs start_ns = now_ns + from_seconds(kStartUpS * options.speed);
    plan.duration_s += kStartUpS * options.speed;
    plan.record.ends_ns = start_ns + from_seconds(recording.last_imu_s);
    simulator.push_back("dataset=" + std::filesystem::absolute(options.dataset).string());
    simulator.push_back("epoch_ns=" + std::to_string(start_ns));
    fusion = start_sets(recording, start_ns);
  }

  if (!options.dataset.empty()) {  // what the scenario has no device for cannot be played
    const auto wired = config::service_overrides(scenario, wiring);
    std::erase_if(bridges, [&](const std::string& bridge) { return wired.count(bridge + "_bridge") == 0; });
  }
  const Sets scenario_fusion = overrides_of(scenario, "fusion", builder.places().config);
  fusion.insert(fusion.end(), scenario_fusion.begin(), scenario_fusion.end());

  builder.write_vehicle(scenario, wiring, bridges, options.standby, {"guidance_example", "simulator"});
  for (const std::string& kind : bridges)
    builder.add(kind + "_bridge", overrides_of(scenario, kind + "_bridge", builder.places().config));
  builder.add_fusion(fusion, fusion_file, options.standby, run_directory);
  builder.add("guidance_example", overrides_of(scenario, "guidance_example", builder.places().config));
  builder.add("simulator", simulator);
  Sets monitor = overrides_of(scenario, "monitor", builder.places().config);
  monitor.push_back("journal.path=" + (run_directory / "alarms.jsonl").string());
  monitor.push_back("metrics.port=" + std::to_string(kMetricsPort + options.domain));
  builder.add("monitor", monitor);
  if (options.record) {
    plan.recordings = recordings_folder(options);
    // 1 GB of what was recorded last is kept.
    builder.add("recorder",
                {"folder=" + plan.recordings.string(), "files.split_mb=256", "files.quota_mb=1024"});
  }
  if (options.console) builder.add_console(options.domain, run_directory);
  // The simulator last: instruments speak when everyone listens.
  const auto simulator_at =
      std::find_if(plan.programs.begin(), plan.programs.end(),
                   [](const launch::Program& program) { return program.name == "simulator"; });
  std::rotate(simulator_at, simulator_at + 1, plan.programs.end());

  const auto monitor_config = config::load_service_config<config::MonitorConfig>(
      config::with_vehicle({"", monitor}, builder.vehicle().string(), "monitor"));
  plan.record.gps_limit_s = monitor_config.value.health.gps.outage.limit_s;
  plan.record.degraded_hold_s = monitor_config.value.health.service.degraded_hold_s;
  plan.record.score_from_s = plan.demands.limits.score_from_s;
  plan.demands.gps_limit_s = plan.record.gps_limit_s;
  plan.demands.silence_s = monitor_config.value.health.service.missing_s;
  plan.demands.startup_s = monitor_config.value.health.startup_s;
  plan.demands.nav_rate_hz = scenario.sensors.of<ImuSample>().rate_hz;
  auto& expected = plan.demands.expected_alarms;
  const std::vector<std::string>& own = plan.demands.limits.expected_alarms;
  expected.insert(expected.end(), own.begin(), own.end());
  expected.insert(expected.end(), options.expected_alarms.begin(), options.expected_alarms.end());
  return plan;
}

}  // namespace fathom::demo
