#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <utility>

#include <fathom/client.hpp>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "client/order_giver.hpp"
#include "client/route_publisher.hpp"

namespace fathom {
namespace {

bus::ParticipantOptions participant_options(const ClientOptions& options) {
  bus::ParticipantOptions out;
  out.name = options.name;
  out.domain = options.domain;
  out.interfaces = options.interfaces;
  out.peers = options.peers;
  out.profiles_dir = options.profiles_dir;
  out.discovery_servers = options.discovery_servers;
  const char* environment = std::getenv("FATHOM_DDS_DIR");
  if (out.profiles_dir.empty() && environment != nullptr) out.profiles_dir = environment;
  if (out.profiles_dir.empty()) out.profiles_dir = options.package_profiles_dir;
  out.security = {options.security.folder, options.security.identity};
  const char* credentials = std::getenv("FATHOM_SECURITY_DIR");
  if (out.security.folder.empty() && credentials != nullptr) out.security.folder = credentials;
  return out;
}

constexpr DurationNs kOvertaken_ns = 10 * kNsPerSecond;

/// A handler that may be replaced at any time, also by itself.
template <class T>
class Callback {
 public:
  void call(const T& sample) {
    const std::lock_guard lock(mutex_);
    const auto handler = handler_;  // kept alive although it may replace itself
    if (handler && *handler) (*handler)(sample);
  }
  void replace(std::function<void(const T&)> handler) {
    const std::lock_guard lock(mutex_);
    handler_ = std::make_shared<std::function<void(const T&)>>(std::move(handler));
  }

 private:
  std::recursive_mutex mutex_;
  std::shared_ptr<std::function<void(const T&)>> handler_;
};

}  // namespace

struct Client::Impl {
  explicit Impl(const ClientOptions& client_options)
      : options(client_options),
        clock(client_options.clock != nullptr ? *client_options.clock : system_clock),
        vehicle(client_options.vehicle),
        participant(participant_options(client_options)),
        route_publisher(participant, clock, client_options.name,
                        [this] {
                          const std::lock_guard lock(mutex);
                          return vehicle;
                        }),
        order_giver(participant, client_options.name, [this] { return header_now(); }) {
    nav_reader.emplace(participant, [this](const NavState& state, const bus::SampleInfo&) { take(state); });
    alignment_reader.emplace(participant, [this](const AlignmentStatus& status, const bus::SampleInfo&) {
      const std::lock_guard lock(mutex);
      if (ours(status.header)) alignment = status;
    });
    monitor_reader.emplace(participant, [this](const MonitorStatus& status, const bus::SampleInfo&) {
      const std::lock_guard lock(mutex);
      if (ours(status.header)) monitor = status;
    });
    alarm_reader.emplace(participant, [this](const Alarm& alarm, const bus::SampleInfo&) {
      {
        const std::lock_guard lock(mutex);
        if (!ours(alarm.header)) return;
      }
      on_alarm.call(alarm);
    });
  }

  /// Precondition: mutex held. An unnamed vehicle is settled by the first that is heard.
  bool ours(const SampleHeader& header) {
    if (vehicle.empty()) vehicle = header.vehicle;
    return header.vehicle == vehicle;
  }

  /// When one fusion service takes over from another, a state of the one may come in behind newer ones of the
  /// other, or say what the other one has said; on a machine that has too much to do, by seconds. Further
  /// behind, it is of a clock set anew. One that repeats its own stamp is no news either: its age goes on.
  /// Precondition: mutex held.
  [[nodiscard]] bool is_news(const NavState& state) const {
    if (!latest) return true;
    const DurationNs behind_ns = latest->header.stamp_ns - state.header.stamp_ns;
    if (state.header.sensor == latest->header.sensor) return behind_ns != 0;
    return behind_ns < 0 || behind_ns >= kOvertaken_ns;
  }

  void take(const NavState& state) {
    {
      const std::lock_guard lock(mutex);
      if (!ours(state.header)) return;
      if (!is_news(state)) return;
      arrived_ns = clock.monotonic_ns();
      ++arrivals;
      latest = state;
    }
    arrival.notify_all();
    on_nav_state.call(state);
  }

  /// By the vehicle's own clock, as far as it has been heard.
  [[nodiscard]] std::optional<SampleHeader> header_now() const {
    const std::lock_guard lock(mutex);
    if (vehicle.empty()) return std::nullopt;
    SampleHeader out;
    out.vehicle = vehicle;
    out.received_ns = latest ? latest->header.stamp_ns + (clock.monotonic_ns() - arrived_ns) : clock.utc_ns();
    out.stamp_ns = out.received_ns;
    return out;
  }

  [[nodiscard]] double age_locked() const {
    return latest ? to_seconds(clock.monotonic_ns() - arrived_ns) : kUnknown;
  }

  ClientOptions options;
  SystemClock system_clock;
  const Clock& clock;

  mutable std::mutex mutex;  ///< guards what follows up to the handlers
  std::condition_variable arrival;
  Name vehicle;
  std::optional<NavState> latest;
  TimeNs arrived_ns = 0;
  std::uint64_t arrivals = 0;
  std::uint64_t returned = 0;  ///< `arrivals` when wait_next last returned
  std::optional<AlignmentStatus> alignment;
  std::optional<MonitorStatus> monitor;

  Callback<NavState> on_nav_state;
  Callback<Alarm> on_alarm;

  bus::Participant participant;
  RoutePublisher route_publisher;
  OrderGiver order_giver;
  // Last: their handlers use all of the above.
  std::optional<bus::Reader<NavState>> nav_reader;
  std::optional<bus::Reader<AlignmentStatus>> alignment_reader;
  std::optional<bus::Reader<MonitorStatus>> monitor_reader;
  std::optional<bus::Reader<Alarm>> alarm_reader;
};

Client::Client(const ClientOptions& options) : impl_(std::make_unique<Impl>(options)) {}

Client::~Client() = default;

void Client::on_nav_state(NavStateHandler handler) {
  impl_->on_nav_state.replace(std::move(handler));
}

void Client::on_alarm(AlarmHandler handler) {
  impl_->on_alarm.replace(std::move(handler));
}

std::optional<NavState> Client::latest() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->latest;
}

double Client::age_s() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->age_locked();
}

std::optional<NavState> Client::wait_next(double timeout_s) {
  std::unique_lock lock(impl_->mutex);
  const bool arrived = impl_->arrival.wait_for(lock, std::chrono::nanoseconds(from_seconds(timeout_s)),
                                               [this] { return impl_->arrivals != impl_->returned; });
  if (!arrived) return std::nullopt;
  impl_->returned = impl_->arrivals;
  return impl_->latest;
}

void Client::publish_route(Route route) {
  impl_->route_publisher.publish(std::move(route));
}

void Client::order(const Command& command, double timeout_s) {
  impl_->order_giver.order(command, timeout_s);
}

void Client::tell(const FixSample& fix, double timeout_s) {
  impl_->order_giver.tell(fix, timeout_s);
}

NavHealth Client::health() const {
  std::optional<NavState> state;
  double age_s = kUnknown;
  {
    const std::lock_guard lock(impl_->mutex);
    state = impl_->latest;
    age_s = impl_->age_locked();
  }
  return judge(state, age_s, impl_->options.limits);
}

std::optional<AlignmentStatus> Client::alignment() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->alignment;
}

std::optional<MonitorStatus> Client::monitor() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->monitor;
}

}  // namespace fathom
