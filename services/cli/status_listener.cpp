#include "cli/status_listener.hpp"

#include <deque>
#include <mutex>
#include <utility>

#include "base/clock.hpp"
#include "bus/reader.hpp"

namespace fathom::cli {
namespace {

constexpr DurationNs kRateWindow = 2 * kNsPerSecond;
constexpr std::size_t kMostNames = 64;  // names come from the network: bounded

template <class T>
struct Stamped {
  T sample;
  TimeNs at_ns = 0;
};

template <class T>
std::optional<Heard<T>> aged(const std::optional<Stamped<T>>& stamped, TimeNs now_ns) {
  if (!stamped) return std::nullopt;
  return Heard<T>{stamped->sample, to_seconds(now_ns - stamped->at_ns)};
}

}  // namespace

struct StatusListener::Impl {
  Impl(const bus::ParticipantOptions& options, const std::string& wanted)
      : domain(static_cast<int>(options.domain)), vehicle(wanted), participant(options) {
    began_ns = clock.monotonic_ns();
    listen<NavState>([this](const NavState& state, TimeNs now_ns) {
      if (!nav || nav->sample.header.stamp_ns != state.header.stamp_ns) nav = {state, now_ns};
      nav_times.push_back(now_ns);
      while (now_ns - nav_times.front() > kRateWindow) nav_times.pop_front();
    });
    listen<AlignmentStatus>([this](const AlignmentStatus& status, TimeNs now_ns) {
      alignment = {status, now_ns};
    });
    listen<MonitorStatus>([this](const MonitorStatus& status, TimeNs now_ns) { monitor = {status, now_ns}; });
    listen<Forecast>([this](const Forecast& sample, TimeNs now_ns) { forecast = {sample, now_ns}; });
    listen<ServiceStatus>([this](const ServiceStatus& status, TimeNs now_ns) {
      if (services.size() < kMostNames || services.contains(status.header.sensor)) {
        services[status.header.sensor] = {status, now_ns};
      }
    });
    listen<Alarm>([this](const Alarm& alarm, TimeNs) {
      if (!alarm.active && alarm.acknowledged) {
        alarms.erase(alarm.alarm);
      } else if (alarms.size() < 2 * kMostNames || alarms.contains(alarm.alarm)) {
        alarms[alarm.alarm] = alarm;
      }
    });
    listen<Verdict>([this](const Verdict& verdict, TimeNs) {
      if (verdicts.size() >= kMostNames && !verdicts.contains(verdict.header.sensor)) return;
      VerdictCounts& counts = verdicts[verdict.header.sensor];
      if (verdict.kind == VerdictKind::used) {
        ++counts.used;
      } else {
        ++counts.not_used;
        counts.last_refusal = verdict.kind;
      }
    });
  }

  template <class T, class Take>
  void listen(Take take) {
    readers.push_back(std::make_shared<bus::Reader<T>>(
        participant, [this, take = std::move(take)](const T& sample, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex);
          if (vehicle.empty()) vehicle = sample.header.vehicle.str();
          if (sample.header.vehicle.view() == vehicle) take(sample, clock.monotonic_ns());
        }));
  }

  [[nodiscard]] double nav_rate(TimeNs now_ns) const {
    if (nav_times.size() < 2 || now_ns - nav_times.back() > kRateWindow) return kUnknown;
    const DurationNs span = nav_times.back() - nav_times.front();
    return span > 0 ? static_cast<double>(nav_times.size() - 1) / to_seconds(span) : kUnknown;
  }

  SystemClock clock;
  int domain;
  TimeNs began_ns = 0;
  mutable std::mutex mutex;  ///< guards what follows up to the participant
  std::string vehicle;
  std::optional<Stamped<NavState>> nav;
  std::deque<TimeNs> nav_times;
  std::optional<Stamped<AlignmentStatus>> alignment;
  std::optional<Stamped<MonitorStatus>> monitor;
  std::optional<Stamped<Forecast>> forecast;
  std::map<Name, Stamped<ServiceStatus>> services;
  std::map<Name, Alarm> alarms;
  std::map<Name, VerdictCounts> verdicts;
  bus::Participant participant;
  std::vector<std::shared_ptr<void>> readers;  ///< last: their handlers use all of the above
};

StatusListener::StatusListener(const bus::ParticipantOptions& options, const std::string& vehicle)
    : impl_(std::make_unique<Impl>(options, vehicle)) {}

StatusListener::~StatusListener() = default;

bool StatusListener::complete() const {
  const std::lock_guard lock(impl_->mutex);
  // One life sign period after the first of both, so that every service and alarm has been heard as well.
  const Impl& self = *impl_;
  if (!self.nav || !self.monitor || self.nav_times.empty()) return false;
  return to_seconds(self.clock.monotonic_ns() - self.nav_times.front()) > 1.2;
}

StatusView StatusListener::view() const {
  const std::lock_guard lock(impl_->mutex);
  const Impl& self = *impl_;
  const TimeNs now_ns = self.clock.monotonic_ns();
  StatusView view;
  view.utc_ns = self.clock.utc_ns();
  view.domain = self.domain;
  view.window_s = to_seconds(now_ns - self.began_ns);
  view.vehicle = self.vehicle;
  view.nav = aged(self.nav, now_ns);
  view.nav_rate_hz = self.nav_rate(now_ns);
  view.alignment = aged(self.alignment, now_ns);
  view.monitor = aged(self.monitor, now_ns);
  view.forecast = aged(self.forecast, now_ns);
  for (const auto& [name, stamped] : self.services) {
    view.services[name] = {stamped.sample, to_seconds(now_ns - stamped.at_ns)};
  }
  view.alarms = self.alarms;
  view.verdicts = self.verdicts;
  return view;
}

}  // namespace fathom::cli
