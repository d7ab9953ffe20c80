#include "console/console_service.hpp"

#include <atomic>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/clock.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "config/error.hpp"
#include "console/http_server.hpp"
#include "console/picture.hpp"
#include "console/picture_json.hpp"
#include "console/refusal_log.hpp"
#include "console/site.hpp"

namespace fathom::console {
namespace {

constexpr int kFirstPort = 8420;
constexpr DurationNs kRetryNs = 3 * kNsPerSecond;
constexpr DurationNs kRefusalPeriodNs = 10 * kNsPerSecond;
// Ten seconds at ten updates a second: more than a browser that is busy with itself takes to come back.
constexpr std::size_t kQueueDepth = 100;

int port_of(const config::ConsoleConfig& config) {
  return config.http.port != 0 ? config.http.port : kFirstPort + config.common.bus.domain;
}

TokenBook tokens_of(const config::ConsoleConfig& config) {
  if (config.access.token_file.empty()) return {};
  try {
    return TokenBook::load(config.access.token_file);
  } catch (const TokenError& error) {
    throw config::ConfigError("access.token_file", error.what());
  }
}

Site::Options site_options(const config::ConsoleConfig& config) {
  Site::Options out;
  out.title = config.common.vehicle;
  out.orders_enabled = config.access.orders;
  out.view_needs_token = config.access.view_needs_token;
  out.tiles_dir = config.map.tiles_dir;
  nlohmann::json waypoints = nlohmann::json::array();
  for (const config::ConsoleWaypoint& point : config.map.waypoints) {
    waypoints.push_back(
        {{"name", point.name}, {"lat_deg", point.latitude_deg}, {"lon_deg", point.longitude_deg}});
  }
  out.waypoints_json = waypoints.dump();
  out.tokens = tokens_of(config);
  return out;
}

HttpServer::Options server_options(const config::ConsoleConfig& config) {
  HttpServer::Options out;
  out.address = config.http.address;
  out.port = port_of(config);
  out.names = config.http.names;
  out.most_connections = static_cast<std::size_t>(config.http.most_connections);
  out.most_per_peer = static_cast<std::size_t>(config.http.most_connections_per_peer);
  return out;
}

}  // namespace

struct ConsoleService::Impl {
  Impl(host::ServiceHost& host_in, const config::ConsoleConfig& config_in)
      : host(host_in),
        config(config_in),
        picture({config.common.vehicle, config.common.bus.domain, config.fresh_s}),
        events(kQueueDepth, static_cast<std::size_t>(config.http.most_streams)),
        commands(host.participant()),
        site(site_options(config),
             {[this] { return snapshot(); },
              [this](const std::string& body, const Identity& who, const std::string& peer) {
                return order(body, who, peer);
              },
              [this](const Refusal& refusal, const std::string& peer) { server.refuse(refusal, peer); }},
             events),
        server(
            server_options(config),
            [this](const RequestHead& head, const std::string& body, const std::string& peer,
                   Connection& connection) { return site.serve(head, body, peer, connection); },
            [this](const Refusal& refusal, const std::string& peer) { say_refused(refusal, peer); }) {
    listen_to<NavState>();
    listen_to<NavDetail>();
    listen_to<Verdict>();
    listen_to<AlignmentStatus>();
    listen_to<MonitorStatus>();
    listen_to<Forecast>();
    listen_to<ServiceStatus>();
    listen_to<Alarm>();
    listen_to<GpsSample>();
    listen_to<UsblSample>();
    listen();
    host.on_status([this](ServiceStatus& status) { fill(status); });
    // Of the host's time: an accelerated vehicle does not make the browsers work more.
    const double period_s = host.clock().rate() / config.updates_hz;
    host.on_tick(from_seconds(period_s), [this] { tick(); });
  }
  ~Impl() {
    events.close();
    site.close();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// UTC is the vehicle's; ages are what people wait for, on the host's own clock.
  health::Instant now() { return {monotonic.monotonic_ns(), host.clock().utc_ns()}; }

  template <class T>
  void listen_to() {
    readers.push_back(
        std::make_shared<bus::Reader<T>>(host.participant(), [this](const T& sample, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex);
          picture.add(sample, now());
        }));
  }

  void listen() {
    tried_ns = monotonic.monotonic_ns();
    const std::string trouble = server.start();
    if (trouble.empty()) {
      host.log().info("console at http://" + config.http.address + ":" + std::to_string(port_of(config)) +
                      "/, orders " + (config.access.orders ? "on" : "off"));
    } else if (trouble != said) {
      host.log().error(trouble);
    }
    const std::lock_guard lock(mutex);
    said = trouble;
  }

  void tick() {
    if (!server.running() && monotonic.monotonic_ns() - tried_ns >= kRetryNs) listen();
    std::unique_lock lock(mutex);
    const Tick fresh = picture.tick(now());
    lock.unlock();
    if (events.clients() == 0) return;  // the text would be for nobody
    // Written once, whole, and shared: the bytes on the wire are the same for everyone.
    events.publish(std::make_shared<const std::string>("event: tick\ndata: " + tick_json(fresh) + "\n\n"));
  }

  /// Any thread. The history is copied under the lock and written without it: samples do not wait for text.
  std::string snapshot() {
    std::unique_lock lock(mutex);
    const Snapshot taken = picture.snapshot();
    lock.unlock();
    return snapshot_json(taken);
  }

  /// Any thread.
  OrderJudgement order(const std::string& body, const Identity& who, const std::string& peer) {
    OrderJudgement judgement = judge_order(body, who, config.access.orders);
    const std::string name = who.name.empty() ? "nobody" : who.name;
    if (judgement.command) {
      judgement.command->header = host.header();
      judgement.command->header.sensor = std::string_view("console:" + name);
      judgement.command->header.sequence = ++sequence;
      if (!commands.write(*judgement.command))
        judgement = {503, "The vehicle network did not take the order.", {}};
    }
    // Every order of somebody known leaves a line with who and when, also one that was refused; strangers are
    // counted and said now and then, so that they cannot fill the disk. Tokens are never written.
    const std::string line =
        " an order of " + name + " (" + std::string(to_string(who.role)) + ") from " + peer + ": ";
    if (judgement.command) {
      ++orders_given;
      host.log().info("passed on" + line + describe(*judgement.command));
    } else {
      ++orders_refused;
      if (who.role != Role::nobody) host.log().warning("refused" + line + judgement.text);
      server.refuse({judgement.status, who.role == Role::nobody ? "order_of_a_stranger" : "order"}, peer);
    }
    return judgement;
  }

  void say_refused(const Refusal& refusal, const std::string& peer) {
    if (const auto line = refusals.add(refusal, peer, monotonic.monotonic_ns())) host.log().warning(*line);
  }

  void fill(ServiceStatus& status) {
    status.state = ServiceState::healthy;
    {
      const std::lock_guard lock(mutex);
      if (!said.empty()) {
        status.state = ServiceState::degraded;
        status.text = said.substr(0, 240);
      }
    }
    const HttpServer::Counters http = server.counters();
    status.counters.push_back({"pages_open", events.clients()});
    status.counters.push_back({"connections", server.connections()});
    status.counters.push_back({"requests", http.requests});
    status.counters.push_back({"requests_refused", http.refused});
    status.counters.push_back({"events_dropped", events.dropped()});
    status.counters.push_back({"orders_given", orders_given});
    status.counters.push_back({"orders_refused", orders_refused});
  }

  host::ServiceHost& host;
  config::ConsoleConfig config;
  SystemClock monotonic;
  std::mutex mutex;  ///< of the picture and of what was said
  Picture picture;
  std::string said;  ///< why nobody can reach the console; empty: all is well
  TimeNs tried_ns = 0;
  RefusalLog refusals{kRefusalPeriodNs};
  std::atomic<std::uint64_t> orders_given{0};
  std::atomic<std::uint64_t> orders_refused{0};
  std::atomic<std::uint64_t> sequence{0};
  FanOut events;
  bus::Writer<Command> commands;
  Site site;
  HttpServer server;
  std::vector<std::shared_ptr<void>> readers;  ///< last: their handlers use all of the above
};

ConsoleService::ConsoleService(host::ServiceHost& host, const config::ConsoleConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}

ConsoleService::~ConsoleService() = default;

}  // namespace fathom::console
