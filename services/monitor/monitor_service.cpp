#include "monitor/monitor_service.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
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
#include "monitor/metrics.hpp"
#include "monitor/record_keeper.hpp"
#include "samples/kinds.hpp"

namespace fathom::monitor {
namespace {

health::HealthConfig health_of(const config::MonitorConfig& config) {
  health::HealthConfig health = config.health;
  health.vehicle = Name(config.common.vehicle);
  return health;
}

constexpr DurationNs kRetryNs = 10 * kNsPerSecond;    // of what could not be opened
constexpr DurationNs kForecastNs = 5 * kNsPerSecond;  // an older forecast is none
constexpr DurationNs kKeepNs = kNsPerSecond;          // of the outages' books
constexpr std::size_t kMostSensors = 64;              // names come from the network: bounded

/// The part of a status that is worth telling at once when it changes.
auto headline(const MonitorStatus& status) {
  return std::tuple(status.known, status.healthy, status.mode, status.alignment, status.gps_outage_active,
                    status.gps_outage_severity, status.alarms_active, status.alarms_unacknowledged);
}

}  // namespace

struct MonitorService::Impl {
  Impl(host::ServiceHost& service_host, const config::MonitorConfig& monitor_config)
      : host(service_host),
        config(monitor_config),
        health(health_of(monitor_config), now(),
               [this](const WriterGuid& writer) { return describe(writer); }),
        status_writer(host.participant()),
        alarm_writer(host.participant()),
        records(monitor_config.journal.path, Name(monitor_config.common.vehicle), service_host.clock(),
                service_host.log()),
        metrics([this] { return snapshot(); }) {
    resume_outages(now());
    restore(now());
    open_metrics(now());
    listen_to_sensors();
    // Who writes it matters, too.
    readers.push_back(std::make_shared<bus::Reader<NavState>>(
        host.participant(), [this](const NavState& state, const bus::SampleInfo& info) {
          const std::lock_guard lock(mutex);
          health.add(state, now(), info.writer_guid);
        }));
    listen<AlignmentStatus>();
    listen<ServiceStatus>();
    listen<Verdict>([this](const Verdict& verdict) { count(verdict); });
    listen<Forecast>([this](const Forecast& told_now) {
      if (told_now.header.vehicle.view() != config.common.vehicle) return;
      forecast = told_now;
      forecast_ns = host.clock().monotonic_ns();
    });
    readers.push_back(std::make_shared<bus::Reader<Command>>(
        host.participant(), [this](const Command& command, const bus::SampleInfo&) { apply(command); }));
    host.on_tick(from_seconds(1.0 / config.evaluation_hz), [this] { tick(); });
    host.on_status([this](ServiceStatus& status) { fill(status); });
  }

  [[nodiscard]] std::string describe(const WriterGuid& writer) const {
    const auto peer = host.participant().peer(writer);
    const std::string name = host.participant().writer_name(writer);
    if (!peer || peer->host.empty()) return name + " (host and process not told)";
    return name + " (process " + std::to_string(peer->pid) + " on host " + peer->host + ")";
  }

  [[nodiscard]] health::Instant now() const { return {host.clock().monotonic_ns(), host.clock().utc_ns()}; }

  template <class T>
  void listen(std::function<void(const T&)> besides = {}) {
    readers.push_back(std::make_shared<bus::Reader<T>>(
        host.participant(), [this, besides = std::move(besides)](const T& sample, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex);
          health.add(sample, now());
          if (besides) besides(sample);
        }));
  }

  void count(const Verdict& verdict) {
    const auto kind = static_cast<std::size_t>(verdict.kind);
    if (verdict.header.vehicle.view() != config.common.vehicle || kind >= kVerdictKinds) return;
    if (!verdict.is_final) return;  // each measurement once, and a counter never falls
    if (verdicts.size() < kMostSensors || verdicts.contains(verdict.header.sensor)) {
      ++verdicts[verdict.header.sensor][kind];
    }
  }

  /// The metrics, where they are wanted and not open yet.
  void open_metrics(const health::Instant& at) {
    tried_ns = at.monotonic_ns;
    if (config.metrics.enabled && !metrics.running()) {
      const std::string trouble = metrics.start(config.metrics.address, config.metrics.port);
      if (trouble.empty()) {
        host.log().info("metrics at http://" + config.metrics.address + ":" +
                        std::to_string(config.metrics.port) + "/metrics");
      }
      complain(trouble, metrics_trouble);
    }
  }

  /// Outages go on over a restart of the monitor.
  void resume_outages(const health::Instant& at) {
    const auto& books = records.books_of_before();
    health.resume(books, at);
    for (const health::GpsOutageBook& book : books) {
      if (book.receiver.empty() && book.record.active) host.log().info("a GPS outage of before goes on");
    }
  }

  /// Alarms are latched until somebody acknowledges them, also when the monitor was started again in between.
  void restore(const health::Instant& at) {
    int restored = 0;
    const std::vector<Alarm> latched = records.take_latched();
    if (latched.empty()) return;
    const std::lock_guard lock(mutex);
    for (const Alarm& alarm : latched) {
      if (alarm.header.vehicle.view() != config.common.vehicle) continue;
      health.restore(alarm, at);
      restored += alarm.acknowledged ? 0 : 1;
    }
    if (restored > 0) {
      host.log().info(std::to_string(restored) + " alarm(s) of before that nobody has acknowledged");
    }
  }

  /// One line when a trouble is new or another one; the monitor goes on.
  void complain(const std::string& trouble, std::string& known) {
    if (!trouble.empty() && trouble != known) host.log().error(trouble);
    known = trouble;
  }

  /// The monitor's own outputs are watched like everything else. Under the lock.
  void judge_outputs(const health::Instant& at) {
    const auto alarm = [&](const char* key, Severity severity, const std::string& trouble) {
      health::Condition condition;
      condition.key = key;
      condition.severity = severity;
      condition.text = trouble.substr(0, 240);
      health.set(!trouble.empty(), condition, at);
    };
    alarm("journal_failed", Severity::warning, records.state().trouble);
    alarm("metrics_unavailable", Severity::notice, metrics_trouble);
  }

  /// Any thread.
  MetricsSnapshot snapshot() {
    MetricsSnapshot out;
    const std::lock_guard lock(mutex);
    const health::Instant at = now();
    out.status = health.status(at);
    out.alarms = health.alarms().all();
    out.horizontal_95_m = health.horizontal_95_m();
    out.verdicts = verdicts;
    out.raised = raised;
    out.acknowledged = commands;
    out.dropped = health.alarms().dropped();
    const RecordKeeper::State kept = records.state();
    out.journal_lines = kept.journal.lines;
    out.journal_failures = kept.journal.failures + kept.dropped;
    if (forecast && at.monotonic_ns - forecast_ns < kForecastNs) {
      const auto count = std::min<std::size_t>(forecast->limit_count, Forecast::kMaxLimits);
      // One series a limit: as it is, not as it would be without this or that aiding.
      out.forecast.clear();
      std::copy_if(forecast->limits.begin(), forecast->limits.begin() + static_cast<std::ptrdiff_t>(count),
                   std::back_inserter(out.forecast),
                   [](const ForecastLimit& limit) { return limit.without.empty(); });
    }
    return out;
  }

  void listen_to_sensors() {
    for_each_kind([this](auto kind) {
      using T = typename decltype(kind)::Sample;
      readers.push_back(std::make_shared<bus::Reader<T>>(
          host.participant(), [this](const T& sample, const bus::SampleInfo& info) {
            const std::lock_guard lock(mutex);
            // Of some the monitor wants to know more than that they came.
            if constexpr (requires { health.add(sample, now(), info.writer_guid); }) {
              health.add(sample, now(), info.writer_guid);
            } else {
              health.heard(kSourceOf<T>, sample.header, now(), info.writer_guid);
            }
          }));
    });
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
    if (const health::Instant at = now(); at.monotonic_ns - tried_ns >= kRetryNs) open_metrics(at);
    restore(now());  // of a journal that could be opened only now
    std::vector<std::string> strangers;
    for (const bus::Stranger& one : host.participant().strangers()) strangers.push_back(bus::to_string(one));
    std::vector<health::AlarmTransition> transitions;
    std::vector<Alarm> repeats;
    std::optional<MonitorStatus> status;
    std::vector<health::GpsOutageBook> books;
    {
      // Nothing is written under the lock: a writer may wait for a thread of the bus that waits for the lock.
      const std::lock_guard lock(mutex);
      const health::Instant at = now();
      judge_outputs(at);
      health.strangers(std::move(strangers), at);
      health.evaluate(at);
      transitions = health.take_transitions();
      books = health.books(at);
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
    for (const health::AlarmTransition& one : transitions) publish(one.alarm);
    for (const Alarm& alarm : repeats) publish(alarm);
    if (status) {
      status->header = host.header();
      status->header.sequence = ++status_sequence;
      status_writer.write(*status);
    }
    keep_outages(books);
    for (const health::AlarmTransition& one : transitions) record(one);
  }

  /// Once a second, and at once when an outage has begun or ended.
  void keep_outages(const std::vector<health::GpsOutageBook>& books) {
    std::uint64_t turns = 0;
    for (const health::GpsOutageBook& book : books)
      turns += 2 * book.record.count + (book.record.active ? 1 : 0);
    const TimeNs now_ns = host.clock().monotonic_ns();
    if (books.empty() || (turns == kept_turns && now_ns - kept_ns < kKeepNs)) return;
    kept_turns = turns;
    kept_ns = now_ns;
    records.keep(books);
  }

  void publish(Alarm alarm) {
    alarm.header = host.header();
    alarm.header.sequence = ++alarm_sequence;
    alarm_writer.write(alarm);
  }

  /// A line in the log and one in the journal. apply() logs acknowledgements, with who gave them, and
  /// restore() what comes from the journal.
  void record(const health::AlarmTransition& transition) {
    using health::AlarmEvent;
    const auto& [event, alarm] = transition;
    if (event == AlarmEvent::restored) return;
    const std::string text = " alarm " + alarm.alarm.str() + ": " + alarm.text;
    if (event == AlarmEvent::cleared) {
      host.log().info("cleared" + text);
    } else if (event != AlarmEvent::acknowledged) {
      const auto level = alarm.severity == Severity::critical  ? runtime::LogLevel::error
                         : alarm.severity == Severity::warning ? runtime::LogLevel::warning
                                                               : runtime::LogLevel::info;
      host.log().write(level, std::string(to_string(alarm.severity)) + text);
    }
    records.append(transition, host.clock().utc_ns());
    const std::lock_guard lock(mutex);
    if (event == AlarmEvent::raised) ++raised[static_cast<std::size_t>(alarm.severity)];
  }

  void fill(ServiceStatus& status) {
    const std::lock_guard lock(mutex);
    status.state = ServiceState::healthy;
    status.counters.push_back({"alarms_active", health.alarms().active_count()});
    status.counters.push_back({"alarms_unacknowledged", health.alarms().unacknowledged_count()});
    status.counters.push_back({"alarms_dropped", health.alarms().dropped()});
    status.counters.push_back({"acknowledgements", commands});
    status.counters.push_back({"journal_dropped", records.state().dropped});
  }

  host::ServiceHost& host;
  config::MonitorConfig config;
  std::mutex
      mutex;  ///< of what follows up to the next heading: handlers, tick and scrapes have their own threads
  health::VehicleHealth health;
  std::uint64_t commands = 0;
  std::map<Name, std::array<std::uint64_t, kVerdictKinds>> verdicts;
  std::optional<Forecast> forecast;
  TimeNs forecast_ns = 0;  ///< monotonic, of its arrival
  std::array<std::uint64_t, 3> raised{};

  // Of the tick's thread only.
  TimeNs published_ns = 0;
  TimeNs repeated_ns = 0;
  std::optional<MonitorStatus> said;
  TimeNs tried_ns = 0;
  std::uint64_t kept_turns = 0;
  TimeNs kept_ns = 0;
  std::string metrics_trouble;
  std::uint64_t status_sequence = 0;
  std::uint64_t alarm_sequence = 0;

  bus::Writer<MonitorStatus> status_writer;
  bus::Writer<Alarm> alarm_writer;
  RecordKeeper records;
  MetricsServer metrics;
  std::vector<std::shared_ptr<void>> readers;  ///< last: their handlers use all of the above
};

MonitorService::MonitorService(host::ServiceHost& host, const config::MonitorConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}

MonitorService::~MonitorService() {
  impl_->records.finish();
}

}  // namespace fathom::monitor
