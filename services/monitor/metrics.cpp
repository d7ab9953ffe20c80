#include "monitor/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <set>
#include <utility>

#include <CivetServer.h>
#include <prometheus/collectable.h>
#include <prometheus/exposer.h>

namespace fathom::monitor {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

/// Collects families; series of unknown value and families without series are left out.
class Builder {
 public:
  explicit Builder(std::string vehicle) : vehicle_(std::move(vehicle)) {}

  Builder& gauge(const char* name, const char* help) { return family(name, help, MetricType::Gauge); }
  Builder& counter(const char* name, const char* help) { return family(name, help, MetricType::Counter); }
  Builder& add(double value, Labels labels = {}) {
    if (std::isnan(value)) return *this;
    ClientMetric metric;
    metric.label.push_back({"vehicle", vehicle_});
    for (auto& label : labels) metric.label.push_back(std::move(label));
    // Two series of one name would make the whole answer invalid: the first one stays.
    if (!seen_.insert(metric.label).second) return *this;
    MetricFamily& family = families_.back();
    (family.type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
    family.metric.push_back(std::move(metric));
    return *this;
  }
  Builder& add(std::uint64_t value, Labels labels = {}) {
    return add(static_cast<double>(value), std::move(labels));
  }
  Builder& add(bool value, Labels labels = {}) { return add(value ? 1.0 : 0.0, std::move(labels)); }
  /// One series per word, 1 for the present one.
  template <class Enum>
  Builder& add_states(const char* label, Enum present, Enum last) {
    for (int i = 0; i <= static_cast<int>(last); ++i) {
      const auto state = static_cast<Enum>(i);
      add(state == present, {{label, std::string(to_string(state))}});
    }
    return *this;
  }
  std::vector<MetricFamily> take() {
    std::erase_if(families_, [](const MetricFamily& family) { return family.metric.empty(); });
    return std::move(families_);
  }

 private:
  Builder& family(const char* name, const char* help, MetricType type) {
    families_.push_back({std::string("fathom_") + name, help, type, {}});
    seen_.clear();
    return *this;
  }

  std::string vehicle_;
  std::vector<MetricFamily> families_;
  std::set<Labels> seen_;
};

void add_navigation(Builder& out, const MetricsSnapshot& now) {
  const MonitorStatus& status = now.status;
  out.gauge("healthy", "1 while the vehicle navigates, GPS is there where expected and no warning is active.")
      .add(status.healthy);
  out.gauge("health_known", "0 while the monitor, just started, cannot say yet how the vehicle is.")
      .add(status.known);
  out.gauge("navigation_mode", "1 for what the navigation state rests on.")
      .add_states("mode", status.mode, NavMode::inertial);
  out.gauge("alignment_phase", "1 for the present phase of alignment.")
      .add_states("phase", status.alignment, AlignmentPhase::lost);
  out.gauge("navigation_state_age_seconds", "Time since the last navigation state.")
      .add(status.nav_state_age_s);
  out.gauge("navigation_horizontal_95_meters", "Radius that holds the position with 95 % probability.")
      .add(now.horizontal_95_m);
  out.gauge("forecast_time_to_limit_seconds",
            "Time until fusion expects its 95 % uncertainty to pass a limit.");
  for (const ForecastLimit& limit : now.forecast)
    out.add(limit.time_to_limit_s, {{"limit", limit.name.str()}});
  out.counter("verdicts_total",
              "Measurements by what fusion made of them in the end, as heard by the monitor.");
  for (const auto& [sensor, counts] : now.verdicts) {
    for (std::size_t kind = 0; kind < counts.size(); ++kind) {
      const auto word = to_string(static_cast<VerdictKind>(kind));
      out.add(counts[kind], {{"sensor", sensor.str()}, {"verdict", std::string(word)}});
    }
  }
}

void add_outages(Builder& out, const MonitorStatus& status) {
  out.gauge("gps_outage_seconds", "Length of the present GPS outage of the vehicle, 0 when there is none.")
      .add(status.gps_outage_s);
  out.gauge("gps_outage_longest_seconds", "The longest GPS outage over restarts of the monitor.")
      .add(status.gps_outage_longest_s);
  out.counter("gps_outage_seconds_total", "Time spent in GPS outages over restarts of the monitor.")
      .add(status.gps_outage_total_s);
  out.counter("gps_outages_total", "GPS outages over restarts of the monitor.")
      .add(std::uint64_t{status.gps_outage_count});
  const auto each = [&](auto value) {
    for (const ReceiverOutage& receiver : status.receivers) {
      out.add(value(receiver), {{"receiver", receiver.name.str()}});
    }
  };
  out.gauge("gps_receiver_outage_seconds", "Length of the present outage of one receiver.");
  each([](const ReceiverOutage& receiver) { return receiver.outage_s; });
  out.gauge("gps_receiver_outage_longest_seconds", "The longest outage of one receiver.");
  each([](const ReceiverOutage& receiver) { return receiver.longest_s; });
  out.counter("gps_receiver_outage_seconds_total", "Time one receiver spent in outages.");
  each([](const ReceiverOutage& receiver) { return receiver.total_s; });
  out.counter("gps_receiver_outages_total", "Outages of one receiver.");
  each([](const ReceiverOutage& receiver) { return std::uint64_t{receiver.count}; });
}

void add_streams(Builder& out, const MonitorStatus& status) {
  const auto each = [&](const std::vector<WatchedItem>& items, const char* label, auto value) {
    for (const WatchedItem& item : items) out.add(value(item), {{label, item.name.str()}});
  };
  const auto present = [](const WatchedItem& item) { return item.presence == Presence::present; };
  const auto age = [](const WatchedItem& item) { return item.age_s; };
  out.gauge("sensor_present", "1 while samples of the sensor come in time.");
  each(status.sensors, "sensor", present);
  out.gauge("sensor_age_seconds", "Time since the last sample of the sensor.");
  each(status.sensors, "sensor", age);
  out.gauge("sensor_rate_hertz", "Samples of the sensor per second, over the last seconds.");
  each(status.sensors, "sensor", [](const WatchedItem& item) { return item.rate_hz; });
  out.gauge("service_present", "1 while life signs of the service come in time.");
  each(status.services, "service", present);
  out.gauge("service_age_seconds", "Time since the last life sign of the service.");
  each(status.services, "service", age);
}

void add_alarms(Builder& out, const MetricsSnapshot& now) {
  out.gauge("alarm_active", "1 while the condition of the alarm holds, 0 until it is acknowledged.");
  for (const Alarm& alarm : now.alarms) {
    out.add(alarm.active,
            {{"alarm", alarm.alarm.str()}, {"severity", std::string(to_string(alarm.severity))}});
  }
  out.gauge("alarms_unacknowledged", "Alarms that no operator has acknowledged.")
      .add(std::uint64_t{now.status.alarms_unacknowledged});
  out.counter("alarms_raised_total", "Alarms raised over restarts of the monitor, by their first severity.");
  for (std::size_t i = 0; i < now.raised.size(); ++i) {
    out.add(now.raised[i], {{"severity", std::string(to_string(static_cast<Severity>(i)))}});
  }
  out.counter("alarm_acknowledgements_total", "Orders to acknowledge that were obeyed.")
      .add(now.acknowledged);
  out.counter("alarms_dropped_total", "Alarms for which there was no room.").add(now.dropped);
  out.counter("journal_lines_total", "Lines of the alarm journal that are on the disk.")
      .add(now.journal_lines);
  out.counter("journal_failures_total", "Lines that could not be written.").add(now.journal_failures);
}

// Each connection has a thread of its own from its beginning to its end. Whoever scrapes asks at once: one
// that has not asked by this time is let go, so that connections which say nothing hold up nobody for long.
constexpr int kThreads = 32;
constexpr DurationNs kRequest_ns = 2 * kNsPerSecond;

class Source final : public prometheus::Collectable {
 public:
  explicit Source(std::function<MetricsSnapshot()> take) : take_(std::move(take)) {}
  [[nodiscard]] std::vector<MetricFamily> Collect() const override { return metric_families(take_()); }

 private:
  std::function<MetricsSnapshot()> take_;
};

}  // namespace

std::vector<MetricFamily> metric_families(const MetricsSnapshot& snapshot) {
  Builder out(snapshot.status.header.vehicle.str());
  add_navigation(out, snapshot);
  add_outages(out, snapshot.status);
  add_streams(out, snapshot.status);
  add_alarms(out, snapshot);
  return out.take();
}

struct MetricsServer::Impl {
  std::shared_ptr<Source> source;
  std::unique_ptr<prometheus::Exposer> exposer;  ///< gone before the source that its threads ask
};

MetricsServer::MetricsServer(std::function<MetricsSnapshot()> take) : impl_(std::make_unique<Impl>()) {
  impl_->source = std::make_shared<Source>(std::move(take));
}

MetricsServer::~MetricsServer() = default;

bool MetricsServer::running() const {
  return impl_->exposer != nullptr;
}

std::string MetricsServer::start(const std::string& address, int port) {
  if (running()) return {};
  const std::string where = address + ":" + std::to_string(port);
  CivetCallbacks callbacks;
  // What the server would print by itself is told here, in one line.
  callbacks.log_message = [](const mg_connection*, const char*) { return 1; };
  const std::vector<std::string> options{
      "listening_ports",    where,
      "num_threads",        std::to_string(kThreads),
      "request_timeout_ms", std::to_string(kRequest_ns / kNsPerMillisecond),
      "enable_keep_alive",  "no",
  };
  try {
    auto exposer = std::make_unique<prometheus::Exposer>(options, &callbacks);
    exposer->RegisterCollectable(impl_->source);
    impl_->exposer = std::move(exposer);
  } catch (const std::exception&) {
    return "metrics: " + where +
           " cannot be listened at (taken, or not an address of this host); expected a " + "free port";
  }
  return {};
}

}  // namespace fathom::monitor
