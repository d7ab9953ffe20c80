#include "host/service_host.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include <unistd.h>

#include "bus/interfaces.hpp"
#include "bus/writer.hpp"
#include "host/deafness.hpp"
#include "host/realtime.hpp"
#include "host/supervisor.hpp"
#include "runtime/build_info.hpp"
#include "runtime/clock_anchor.hpp"
#include "runtime/leave.hpp"
#include "runtime/signals.hpp"

namespace fathom::host {
namespace {

constexpr DurationNs kLifeSignPeriod = kNsPerSecond;

std::unique_ptr<Clock> make_clock(const config::ClockConfig& config, const runtime::ClockAnchor& anchor) {
  if (config.epoch_ns == 0) return std::make_unique<AnchoredClock>(anchor.utc_minus_monotonic_ns());
  return std::make_unique<ScaledClock>(config.epoch_ns, config.rate);
}

runtime::LogLevel log_level(const std::string& word) {
  auto level = runtime::LogLevel::info;
  (void)runtime::parse_log_level(word, level);
  return level;
}

bus::ParticipantOptions participant_options(const ServiceHost::Start& start) {
  bus::ParticipantOptions out;
  out.name = start.info.name;
  out.low_priority = start.info.low_priority;
  out.domain = static_cast<std::uint32_t>(start.common.bus.domain);
  out.interfaces = start.common.bus.interfaces;
  out.peers = start.common.bus.peers;
  out.profiles_dir = start.common.bus.profiles_dir;
  out.security = {start.common.bus.security.folder, start.common.bus.security.identity};
  out.discovery_servers = start.common.bus.discovery_servers;
  out.discovery_listen = start.discovery_listen;
  return out;
}

std::string event_text(const bus::BusEvent& event) {
  const std::string topic = event.topic.empty() ? "" : event.topic + ": ";
  return "bus: " + topic + std::string(bus::to_string(event.kind)) +
         (event.detail.empty() ? "" : ": " + event.detail);
}

/// Returns how many of the service's own counters found no room.
std::size_t append_bus_counters(const bus::BusCounters& counters, ServiceStatus& status) {
  const std::pair<const char*, std::uint64_t> all[] = {
      {"bus_incompatible_qos", counters.incompatible_qos},
      {"bus_deadline_missed", counters.deadline_missed},
      {"bus_writer_lost", counters.writer_lost},
      {"bus_sample_lost", counters.sample_lost},
      {"bus_write_failed", counters.write_failed},
      {"bus_resource_limit", counters.resource_limit},
      {"bus_invalid_sample", counters.invalid_sample},
      {"bus_stranger_refused", counters.stranger_refused},
      {"bus_permission_refused", counters.permission_refused},
      {"bus_malformed_datagram", counters.malformed_datagram}};
  // The bus's counters are the same for every service and must not be crowded out.
  const std::size_t own = status.counters.size();
  status.counters.resize(std::min(own, kMostCounters - std::size(all)));
  const std::size_t left_out = own - status.counters.size();
  for (const auto& [name, value] : all) status.counters.push_back({name, value});
  return left_out;
}

}  // namespace

struct ServiceHost::Impl {
  explicit Impl(Start start_in)
      : start(std::move(start_in)),
        realtime_warnings(apply_realtime(start.common.realtime)),
        log("fathom-" + start.info.name, log_level(start.common.log.level)),
        anchor(start.common.clock.anchor_file, SystemClock()),
        clock(make_clock(start.common.clock, anchor)),
        without_link(bus::without_link(start.common.bus.interfaces)),
        awake_ns(SystemClock().boottime_ns()),
        participant(participant_options(start)),
        status_writer(participant),
        deafness(start.common.bus.domain),
        started_ns(clock->utc_ns()) {}

  [[nodiscard]] SampleHeader header() const;
  void publish(ServiceState state);
  void judge_credentials(ServiceStatus& status);
  /// True when this process stood still for so long that nobody on a protected network will speak to it
  /// again.
  bool given_up();
  /// True when a network card has a link that had none when this service started, which does not use it.
  bool has_more_links();
  /// Ends the process when it hears nothing any more. What is locked stays so: nothing is taken down.
  void leave_if_deaf();

  Start start;
  std::vector<std::string> realtime_warnings;  ///< before all threads: they inherit what was asked for
  runtime::Log log;
  runtime::ClockAnchor anchor;
  std::unique_ptr<Clock> clock;
  runtime::StopSignal stop_signal;
  std::vector<bus::LocalAddress> without_link;  ///< as this service started
  TimeNs awake_ns;  ///< since the host's start. Others may meet this service, and give it up, before it runs
  bus::Participant participant;
  bus::Writer<ServiceStatus> status_writer;
  Deafness deafness;
  TimeNs started_ns;
  std::uint64_t sequence = 0;
  bool counters_left_out = false;
  std::function<void(ServiceStatus&)> fill;
  std::function<void()> tick;
  DurationNs tick_period_ns = 0;
  std::atomic<bool> publish_soon{false};
  std::atomic<bool> stop_requested{false};
  std::atomic<int> exit_code{-1};
  std::string credentials_said;
};

SampleHeader ServiceHost::Impl::header() const {
  const TimeNs now = clock->utc_ns();
  return {std::string_view(start.common.vehicle), std::string_view(start.info.name), now, now, 0};
}

/// The end of the credentials, by the host's own clock: others judge them by theirs.
void ServiceHost::Impl::judge_credentials(ServiceStatus& status) {
  const TimeNs now = SystemClock().utc_ns();
  const std::string warning = participant.credentials_warning(now);
  if (warning.empty()) return;
  if (warning != credentials_said) log.warning(warning + ": renew it with fathom keygen --rotate");
  credentials_said = warning;
  status.text += (status.text.empty() ? "" : "; ") + warning;
  // Who knows this service goes on speaking to it; who meets it anew does not.
  if (now > *participant.credentials_until_ns() && status.state == ServiceState::healthy) {
    status.state = ServiceState::degraded;
  }
}

bool ServiceHost::Impl::given_up() {
  const TimeNs now = SystemClock().boottime_ns();
  const DurationNs stood_still_ns = now - awake_ns;
  awake_ns = now;
  const auto longest = participant.longest_silence_ns();
  if (!longest || stood_still_ns < *longest) return false;
  log.error("stood still for " + std::to_string(stood_still_ns / kNsPerSecond) +
            " s: the others have given this service up and it has to be started again");
  return true;
}

bool ServiceHost::Impl::has_more_links() {
  if (without_link.empty()) return false;
  const std::vector<bus::LocalAddress> still = bus::without_link(start.common.bus.interfaces);
  for (const bus::LocalAddress& one : without_link) {
    const bool gained = std::none_of(still.begin(), still.end(), [&](const bus::LocalAddress& other) {
      return other.address == one.address;
    });
    if (!gained) continue;
    log.warning(
        "network card " + one.card + " (" + one.address +
        ") has a link now, and had none when this service started: it has to be started again to use it");
    return true;
  }
  return false;
}

void ServiceHost::Impl::leave_if_deaf() {
  if (!deafness.look(SystemClock().monotonic_ns())) return;
  log.error(
      "what arrives from the vehicle network has waited for 10 s and nothing takes it: a thread of Fast DDS "
      "stands still, and this service has to be started again");
  log.flush();
  runtime::abandon(static_cast<int>(ExitCode::runtime_failure));
}

void ServiceHost::Impl::publish(ServiceState state) {
  ServiceStatus status;
  status.header = header();
  status.header.sequence = ++sequence;
  status.state = state;
  status.version = runtime::version();
  status.config_hash = start.config_hash;
  status.host = runtime::host_name();
  status.pid = static_cast<std::uint32_t>(getpid());
  status.started_ns = started_ns;
  // An accelerated clock has nothing to do with the host's UTC.
  if (start.common.clock.epoch_ns == 0) status.utc_offset_ns = SystemClock().utc_ns() - clock->utc_ns();
  if (fill) fill(status);
  judge_credentials(status);
  if (state == ServiceState::stopping) status.state = state;
  for (const std::string& warning : realtime_warnings) {
    status.text += (status.text.empty() ? "" : "; ") + warning;
  }
  const std::size_t left_out = append_bus_counters(participant.counters(), status);
  if (left_out > 0 && !std::exchange(counters_left_out, true)) {
    log.error(std::to_string(left_out) +
              " counters of this service do not fit into its life sign, which carries " +
              std::to_string(kMostCounters));
  }
  status_writer.write(status);
  std::string text(to_string(status.state));
  if (!status.text.empty()) text += ": " + status.text;
  supervisor::alive(text);
}

ServiceHost::ServiceHost(Start start) : impl_(std::make_unique<Impl>(std::move(start))) {
  for (const std::string& warning : impl_->realtime_warnings) impl_->log.warning(warning);
  if (!impl_->anchor.trouble().empty()) {
    impl_->log.warning(
        "clock: " + impl_->anchor.trouble() +
        "; when the host's clock is set, services that start afterwards will not agree with those before");
  }
  impl_->participant.on_event(
      [log = &impl_->log](const bus::BusEvent& event) { log->warning(event_text(event)); });
}

ServiceHost::~ServiceHost() = default;

const config::CommonConfig& ServiceHost::common() const {
  return impl_->start.common;
}
const std::string& ServiceHost::config_hash() const {
  return impl_->start.config_hash;
}

const std::string& ServiceHost::name() const {
  return impl_->start.info.name;
}
Clock& ServiceHost::clock() {
  return *impl_->clock;
}
runtime::Log& ServiceHost::log() {
  return impl_->log;
}
bus::Participant& ServiceHost::participant() {
  return impl_->participant;
}

SampleHeader ServiceHost::header() const {
  return impl_->header();
}

DurationNs ServiceHost::host_duration(DurationNs vehicle_ns) const {
  return static_cast<DurationNs>(static_cast<double>(vehicle_ns) / impl_->clock->rate());
}

void ServiceHost::on_status(std::function<void(ServiceStatus&)> fill) {
  impl_->fill = std::move(fill);
}

void ServiceHost::on_tick(DurationNs period_ns, std::function<void()> tick) {
  impl_->tick_period_ns = period_ns;
  impl_->tick = std::move(tick);
}

void ServiceHost::publish_status_soon() {
  impl_->publish_soon = true;
  impl_->stop_signal.wake();
}

void ServiceHost::stop(ExitCode code) {
  int none = -1;
  impl_->exit_code.compare_exchange_strong(none, static_cast<int>(code));
  impl_->stop_requested = true;
  impl_->stop_signal.wake();
}

ExitCode ServiceHost::run() {
  Impl& impl = *impl_;
  impl.log.info("started, version " + std::string(runtime::version()) + ", configuration " +
                impl.start.config_hash + ", vehicle " + impl.start.common.vehicle + ", domain " +
                std::to_string(impl.start.common.bus.domain));
  for (const bus::LocalAddress& one : impl.without_link)
    impl.log.warning("network card " + one.card + " (" + one.address +
                     ") has no link and is not used: no cable, or what is at its other end is off");
  supervisor::ready();
  TimeNs next_life_sign = impl.clock->monotonic_ns();
  TimeNs next_tick = next_life_sign;
  try {
    while (!impl.stop_requested) {
      if (impl.given_up()) stop(ExitCode::runtime_failure);
      impl.leave_if_deaf();
      const TimeNs now = impl.clock->monotonic_ns();
      if (impl.tick && now >= next_tick) {
        impl.tick();
        next_tick += impl.tick_period_ns * (1 + (now - next_tick) / impl.tick_period_ns);
      }
      const bool due = now >= next_life_sign;
      if (impl.publish_soon.exchange(false) || due) impl.publish(ServiceState::healthy);
      if (due && impl.has_more_links()) stop(ExitCode::runtime_failure);
      if (due) next_life_sign += kLifeSignPeriod * (1 + (now - next_life_sign) / kLifeSignPeriod);
      const TimeNs next = impl.tick ? std::min(next_tick, next_life_sign) : next_life_sign;
      const auto woken = impl.stop_signal.wait(host_duration(next - impl.clock->monotonic_ns()));
      if (woken == runtime::StopSignal::Woken::signal) stop(ExitCode::done);
    }
  } catch (...) {
    impl.fill = nullptr;  // it may be what failed
    impl.publish(ServiceState::stopping);
    throw;
  }
  supervisor::stopping();
  impl.publish(ServiceState::stopping);
  impl.log.info("stopped");
  return static_cast<ExitCode>(impl.exit_code.load());
}

}  // namespace fathom::host
