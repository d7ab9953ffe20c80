#include "simulator/simulator_service.hpp"

#include <utility>

namespace fathom::simulator {
namespace {

// A message may leave this late before the service calls itself degraded, host time.
constexpr double kLate_s = 0.2;

TimeNs start_of(const config::SimulatorConfig& config, const Clock& clock) {
  if (config.epoch_ns != 0) return config.epoch_ns;
  const TimeNs earliest = clock.utc_ns() + from_seconds(config.start_delay_s);
  return (earliest + kNsPerSecond - 1) / kNsPerSecond * kNsPerSecond;
}

}  // namespace

SimulatorService::SimulatorService(host::ServiceHost& host, const config::SimulatorConfig& config)
    : host_(host), config_(config), truth_writer_(host.participant()) {
  const sim::Scenario& scenario = config_.loaded;
  sim::Simulation::Options options;
  options.epoch_ns = start_of(config, host.clock());
  options.seed = config.seed;
  options.vehicle = Name(std::string_view(config.common.vehicle));
  auto source = config.dataset.empty() ? simulate(scenario, options, config.truth_rate_hz)
                                       : play(config.dataset, scenario, options);
  host.log().info((config.dataset.empty()
                       ? "scenario " + scenario.name + ", seed " + std::to_string(config.seed)
                       : "recorded vehicle " + config.dataset) +
                  ", starts " + to_iso8601(options.epoch_ns));
  player_ = std::make_unique<Player>(std::move(source), scenario, options.epoch_ns, config.link_dir,
                                     config.port_offset, host.clock(),
                                     [this](const Truth& truth) { (void)truth_writer_.write(truth); });
  for (const auto& device : player_->devices()) host.log().info(device);
  status_before_ns_ = host.clock().monotonic_ns();
  host.on_status([this](ServiceStatus& status) { fill(status); });
}

void SimulatorService::fill(ServiceStatus& status) {
  const PlayerStatus now = player_->status();
  const TimeNs monotonic = host_.clock().monotonic_ns();
  const double dt = to_seconds(monotonic - status_before_ns_);
  status_before_ns_ = monotonic;
  for (const auto& [kind, count] : now.messages_of) {
    auto& before = messages_before_[kind];
    if (dt > 0.0)
      status.rates.push_back({Name(std::string_view(kind)), static_cast<double>(count - before) / dt});
    before = count;
  }
  std::uint64_t sent = 0;
  std::uint64_t dropped = 0;
  for (const auto& [where, link] : now.links) {
    sent += link.bytes_sent;
    dropped += link.bytes_dropped;
  }
  status.counters.push_back({"messages", now.messages});
  status.counters.push_back({"bytes_sent", sent});
  status.counters.push_back({"bytes_dropped", dropped});
  status.state = ServiceState::healthy;
  if (now.latest_s > kLate_s * host_.clock().rate()) {
    status.state = ServiceState::degraded;
    status.text = "the host is too slow: bytes leave " + std::to_string(now.latest_s) + " s late";
  } else if (now.finished) {
    status.text = "the recording has ended";
  }
  if (now.finished && !said_finished_) host_.log().info("the recording has ended");
  said_finished_ = now.finished;
}

}  // namespace fathom::simulator
