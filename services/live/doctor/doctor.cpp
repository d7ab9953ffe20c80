#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/clock.hpp"
#include "bus/network_map.hpp"
#include "bus/reader.hpp"
#include "cli/bus_options.hpp"
#include "cli/command.hpp"
#include "cli/live_commands.hpp"
#include "health/writers/service_watch.hpp"
#include "live/command.hpp"
#include "live/doctor/checks.hpp"
#include "live/doctor/host.hpp"

namespace fathom::cli {
namespace {

struct DoctorOptions {
  bus::ParticipantOptions bus;
  double seconds = 4.0;
  bool clean = false;
  bool json = false;
};

/// Hears every service's life sign and how late it comes.
class LifeSigns {
 public:
  explicit LifeSigns(bus::Participant& participant)
      : reader_(participant, [this](const ServiceStatus& status, const bus::SampleInfo&) { heard(status); }) {
  }

  [[nodiscard]] std::vector<HeardService> all() const {
    const std::lock_guard lock(mutex_);
    std::vector<HeardService> out;
    for (const auto& [name, one] : services_) {
      out.push_back(one);
      out.back().voices.forget(clock_.monotonic_ns(), kGone_s);
    }
    return out;
  }

 private:
  void heard(const ServiceStatus& status) {
    const TimeNs host_utc_ns = status.header.stamp_ns + status.utc_offset_ns;
    const double behind_s = to_seconds(clock_.utc_ns() - host_utc_ns);
    const std::lock_guard lock(mutex_);
    HeardService& one = services_[status.header.sensor];
    one.status = status;
    one.voices.forget(clock_.monotonic_ns(), kGone_s);
    (void)one.voices.hear(status, clock_.monotonic_ns());
    // The first comes from the writer's memory and may be a second old; the quickest tells the clocks apart.
    one.behind_s = known(one.behind_s) ? std::min(one.behind_s, behind_s) : behind_s;
  }

  static constexpr double kGone_s = health::ServiceWatchConfig{}.missing_s;

  SystemClock clock_;
  mutable std::mutex mutex_;
  std::map<Name, HeardService> services_;
  bus::Reader<ServiceStatus> reader_;  ///< last: its handler uses the others
};

NetworkFacts look_at_network(const DoctorOptions& options) {
  bus::ParticipantOptions presence = options.bus;
  presence.discover_everything = true;  // a server tells others only of the topics they share
  bus::Participant participant(presence);
  const LifeSigns signs(participant);
  std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds));
  (void)participant.counters();  // judges those who never proved an identity
  NetworkFacts out;
  out.domain = options.bus.domain;
  out.interfaces = options.bus.interfaces;
  out.participants = participant.peers();
  out.is_protected = participant.credentials_until_ns().has_value();
  out.strangers = participant.strangers();
  out.endpoints = bus::endpoints(participant);
  out.conflicts = bus::conflicts(participant);
  out.services = signs.all();
  return out;
}

void print_table(const std::vector<Finding>& findings) {
  for (const Finding& one : findings) {
    const char* mark = one.level == FindingLevel::good     ? "  ok    "
                       : one.level == FindingLevel::notice ? "  note  "
                                                           : "PROBLEM ";
    std::printf("%s %-9s %s\n", mark, one.subject.c_str(), one.text.c_str());
    if (!one.remedy.empty()) std::printf("%19s-> %s\n", "", one.remedy.c_str());
  }
}

void print_json(const std::vector<Finding>& findings) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Finding& one : findings) {
    out.push_back({{"level", to_string(one.level)},
                   {"subject", one.subject},
                   {"text", one.text},
                   {"remedy", one.remedy}});
  }
  std::puts(nlohmann::ordered_json{{"findings", out}}.dump().c_str());
}

ExitCode run(const DoctorOptions& options) {
  HostFacts host = look_at_host();
  if (options.clean) {
    const auto kept = remove_leftovers(host.shm_leftovers);
    std::fprintf(stderr, "%zu files removed from /dev/shm\n", host.shm_leftovers.size() - kept.size());
    for (const ShmLeftover& one : kept)
      std::fprintf(stderr, "fathom: %s: cannot be removed\n", one.path.c_str());
    host.shm_leftovers = kept;
  }
  const auto findings = examine(look_at_network(options), host);
  options.json ? print_json(findings) : print_table(findings);
  const bool ill = std::any_of(findings.begin(), findings.end(),
                               [](const Finding& one) { return one.level == FindingLevel::problem; });
  return ill ? ExitCode::no : ExitCode::done;
}

}  // namespace

void add_doctor(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<DoctorOptions>();
  options->bus.name = "fathom_doctor";
  CLI::App* command = app.add_subcommand(kDoctor.name, kDoctor.description);
  command->footer("Exit code: 0 nothing wrong (notes are allowed), 1 a problem was found.");
  command->add_flag("--clean", options->clean, "Remove what Fast DDS left in /dev/shm and nobody uses");
  command->add_flag("--json", options->json, "One line of JSON");
  add_bus_options(*command, options->bus, "cli");
  command->add_option("--seconds", options->seconds, "How long to listen")
      ->check(CLI::Range(0.5, 600.0))
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fathom::cli
