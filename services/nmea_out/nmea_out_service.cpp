#include "nmea_out/nmea_out_service.hpp"

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/forward_only.hpp"
#include "bus/reader.hpp"
#include "nmea_out/outlet.hpp"
#include "nmea_out/report.hpp"
#include "nmea_out/schedule.hpp"
#include "samples/nav_state.hpp"

namespace fathom::nmea_out {
namespace {

constexpr DurationNs kTick_ns = kNsPerSecond / 20;

}  // namespace

struct NmeaOutService::Impl {
  Impl(host::ServiceHost& the_host, const config::NmeaOutConfig& the_config)
      : host(the_host),
        config(the_config),
        schedules(config.outputs.begin(), config.outputs.end()),
        outlets(config.outputs,
                [log = &the_host.log()](bool is_trouble, const std::string& text) {
                  log->write(is_trouble ? runtime::LogLevel::warning : runtime::LogLevel::info, text);
                }),
        heard_ns(host.clock().monotonic_ns()),
        reader(host.participant(), [this](const NavState& state, const bus::SampleInfo&) { take(state); }) {
    host.on_tick(kTick_ns, [this] { tick(); });
    host.on_status([this](ServiceStatus& status) { fill(status); });
  }
  ~Impl() {
    host.on_tick(kTick_ns, [] {});
    host.on_status([](ServiceStatus&) {});
  }

  void take(const NavState& state) {
    const std::lock_guard lock(mutex);
    if (!forward.takes(state.header.stamp_ns)) return;
    heard_ns = host.clock().monotonic_ns();
    ++states;
    say(report_of(state, config));
  }

  /// Without states the loss itself is what readers have to hear.
  void tick() {
    const std::lock_guard lock(mutex);
    if (!silent()) return;
    say(nothing_at(host.clock().utc_ns()));
  }

  /// Under the lock.
  [[nodiscard]] bool silent() const {
    return host.clock().monotonic_ns() - heard_ns > from_seconds(config.silence_s);
  }
  void say(const Report& report) {
    for (std::size_t i = 0; i < schedules.size(); ++i) {
      std::string text = schedules[i].due(report);
      if (!text.empty()) outlets.send(i, std::move(text));
    }
  }

  void fill(ServiceStatus& status) {
    std::uint64_t bytes = 0;
    std::uint64_t dropped = 0;
    std::uint64_t clients = 0;
    std::uint64_t clients_refused = 0;
    std::string trouble;
    for (const OutletStatus& outlet : outlets.status()) {
      bytes += outlet.bytes;
      dropped += outlet.dropped;
      clients += static_cast<std::uint64_t>(outlet.clients);
      clients_refused += outlet.clients_refused;
      if (!outlet.trouble.empty() && trouble.empty()) trouble = outlet.name + ": " + outlet.trouble;
    }
    const std::lock_guard lock(mutex);
    status.counters.push_back({"states", states});
    status.counters.push_back({"bytes", bytes});
    status.counters.push_back({"bytes_dropped", dropped});
    status.counters.push_back({"clients", clients});
    status.counters.push_back({"clients_refused", clients_refused});
    if (!trouble.empty()) {
      status.state = ServiceState::degraded;
      status.text = trouble;
    } else if (silent()) {
      status.state = ServiceState::degraded;
      status.text = "no navigation state is heard: readers are told that there is no position";
    }
  }

  host::ServiceHost& host;
  const config::NmeaOutConfig config;
  std::mutex mutex;  // of what follows up to the outlets
  std::vector<Schedule> schedules;
  ForwardOnly forward;
  std::uint64_t states = 0;
  Outlets outlets;
  TimeNs heard_ns;
  bus::Reader<NavState> reader;  // ends first: it uses everything above
};

NmeaOutService::NmeaOutService(host::ServiceHost& host, const config::NmeaOutConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}
NmeaOutService::~NmeaOutService() = default;

}  // namespace fathom::nmea_out
