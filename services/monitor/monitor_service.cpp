#include "monitor/monitor_service.hpp"

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "health/vehicle_health.hpp"
#include "samples/actuator.hpp"
#include "samples/airspeed.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/heading.hpp"
#include "samples/imu.hpp"
#include "samples/usbl.hpp"

namespace fathom::monitor {
namespace {

health::HealthConfig health_of(const config::MonitorConfig& config) {
  health::HealthConfig health = config.health;
  health.vehicle = Name(config.common.vehicle);
  return health;
}

/// The part of a status that is worth telling at once when it changes.
auto headline(const MonitorStatus& status) {
  return std::tuple(status.healthy, status.mode, status.alignment, status.gps_outage_active,
                    status.gps_outage_severity, status.alarms_active, status.alarms_unacknowledged);
}

}  // namespace

struct MonitorService::Impl {
  Impl(host::ServiceHost& service_host, const config::MonitorConfig& monitor_config)
      : host(service_host),
        config(monitor_config),
        health(health_of(monitor_config), now(),
               [this](const health::WriterId& writer) { return describe(writer); }),
        status_writer(host.participant()),
        alarm_writer(host.participant()) {
    listen_to_sensors();
    listen<NavState>();
    listen<AlignmentStatus>();
    listen<ServiceStatus>();
    listen<Verdict>();
    listen<Forecast>();
    readers.push_back(std::make_shared<bus::Reader<Command>>(
        host.participant(), [this](const Command& command, const bus::SampleInfo&) { apply(command); }));
    host.on_tick(from_seconds(1.0 / config.evaluation_hz), [this] { tick(); });
    host.on_status([this](ServiceStatus& status) { fill(status); });
  }

  [[nodiscard]] std::string describe(const health::WriterId& writer) const {
    const auto peer = host.participant().peer(writer);
    const std::string name = host.participant().writer_name(writer);
    if (!peer || peer->host.empty()) return name + " (host and process not told)";
    return name + " (process " + std::to_string(peer->pid) + " on host " + peer->host + ")";
  }

  [[nodiscard]] health::Instant now() const { return {host.clock().monotonic_ns(), host.clock().utc_ns()}; }

  template <class T>
  void listen() {
    readers.push_back(
        std::make_shared<bus::Reader<T>>(host.participant(), [this](const T& sample, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex);
          health.add(sample, now());
        }));
  }

  /// A sensor whose samples say more than that they came.
  template <class T>
  void listen_closely() {
    readers.push_back(std::make_shared<bus::Reader<T>>(host.participant(),
                                                       [this](const T& sample, const bus::SampleInfo& info) {
                                                         const std::lock_guard lock(mutex);
                                                         health.add(sample, now(), info.writer_guid);
                                                       }));
  }

  template <class T>
  void listen_to(SourceKind kind) {
    readers.push_back(std::make_shared<bus::Reader<T>>(
        host.participant(), [this, kind](const T& sample, const bus::SampleInfo& info) {
          const std::lock_guard lock(mutex);
          health.heard(kind, sample.header, now(), info.writer_guid);
        }));
  }

  void listen_to_sensors() {
    listen_closely<GpsSample>();
    listen_closely<DvlSample>();
    listen_to<ImuSample>(SourceKind::imu);
    listen_to<DepthSample>(SourceKind::depth);
    listen_to<HeadingSample>(SourceKind::heading);
    listen_to<UsblSample>(SourceKind::usbl);
    listen_to<AirspeedSample>(SourceKind::airspeed);
    listen_to<PropulsionSample>(SourceKind::propulsion);
    listen_to<FinsSample>(SourceKind::fins);
  }

  void apply(const Command& command) {
    int acknowledged = 0;
    {
      const std::lock_guard lock(mutex);
      acknowledged = health.apply(command, now());
      commands += command.kind == CommandKind::acknowledge_alarm ? 1 : 0;
    }
    if (acknowledged > 0) {
      host.log().info(std::to_string(acknowledged) + " alarm(s) acknowledged by " +
                      command.header.sensor.str() + " (" + command.target.str() + ")");
    }
  }

  void tick() {
    std::vector<Alarm> changes;
    std::vector<Alarm> repeats;
    std::optional<MonitorStatus> status;
    {
      // Nothing is written under the lock: a writer may wait for a thread of the bus that waits for the lock.
      const std::lock_guard lock(mutex);
      const health::Instant at = now();
      health.evaluate(at);
      changes = health.take_changes();
      if (at.monotonic_ns - repeated_ns >= from_seconds(config.alarm_repeat_s)) {
        repeated_ns = at.monotonic_ns;
        repeats = health.alarms().all();
      }
      MonitorStatus fresh = health.status(at);
      const bool due = at.monotonic_ns - published_ns >= from_seconds(1.0 / config.status_hz);
      if (due || !said || headline(fresh) != headline(*said)) {
        published_ns = at.monotonic_ns;
        said = fresh;
        status = std::move(fresh);
      }
    }
    for (const Alarm& alarm : changes) {
      tell(alarm);
      publish(alarm);
    }
    for (const Alarm& alarm : repeats) publish(alarm);
    if (status) {
      status->header = host.header();
      status->header.sequence = ++status_sequence;
      status_writer.write(*status);
    }
  }

  void publish(Alarm alarm) {
    alarm.header = host.header();
    alarm.header.sequence = ++alarm_sequence;
    alarm_writer.write(alarm);
  }

  /// One line when an alarm is raised, becomes more severe or clears; acknowledgements are logged by apply().
  void tell(const Alarm& alarm) {
    const std::string text = " alarm " + alarm.alarm.str() + ": " + alarm.text;
    const auto known = told.find(alarm.alarm);
    if (!alarm.active) {
      if (known == told.end()) return;
      told.erase(known);
      host.log().info("cleared" + text);
    } else if (known == told.end() || known->second != alarm.severity) {
      told[alarm.alarm] = alarm.severity;
      const auto level = alarm.severity == Severity::critical  ? runtime::LogLevel::error
                         : alarm.severity == Severity::warning ? runtime::LogLevel::warning
                                                               : runtime::LogLevel::info;
      host.log().write(level, std::string(to_string(alarm.severity)) + text);
    }
  }

  void fill(ServiceStatus& status) {
    const std::lock_guard lock(mutex);
    status.state = ServiceState::healthy;
    status.counters.push_back({"alarms_active", health.alarms().active_count()});
    status.counters.push_back({"alarms_unacknowledged", health.alarms().unacknowledged_count()});
    status.counters.push_back({"alarms_dropped", health.alarms().dropped()});
    status.counters.push_back({"acknowledgements", commands});
  }

  host::ServiceHost& host;
  config::MonitorConfig config;
  std::mutex mutex;  ///< guards health and commands: readers' handlers and the tick run on different threads
  health::VehicleHealth health;
  std::uint64_t commands = 0;

  // Of the tick's thread only.
  TimeNs published_ns = 0;
  TimeNs repeated_ns = 0;
  std::optional<MonitorStatus> said;
  std::map<Name, Severity> told;  ///< alarms logged as raised and not yet as cleared
  std::uint64_t status_sequence = 0;
  std::uint64_t alarm_sequence = 0;

  bus::Writer<MonitorStatus> status_writer;
  bus::Writer<Alarm> alarm_writer;
  std::vector<std::shared_ptr<void>> readers;  ///< last: their handlers use all of the above
};

MonitorService::MonitorService(host::ServiceHost& host, const config::MonitorConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}

MonitorService::~MonitorService() = default;

}  // namespace fathom::monitor
