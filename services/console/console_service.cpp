#include "console/console_service.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/clock.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "console/http/http_server.hpp"
#include "console/http/precautions.hpp"
#include "console/orders/awaited_verdicts.hpp"
#include "console/site.hpp"
#include "console/view/vehicle_view.hpp"
#include "console/view/vehicle_view_json.hpp"
#include "health/text.hpp"
#include "runtime/refusal_log.hpp"

namespace fathom::console {
namespace {

constexpr DurationNs kRetryNs = 3 * kNsPerSecond;
constexpr DurationNs kDayNs = 24 * std::int64_t{3600} * kNsPerSecond;
// Ten seconds at ten updates a second: more than a browser that is busy with itself takes to come back.
constexpr std::size_t kQueueDepth = 100;
// For navigation's word on a position that was told. It says it at once; a page waits for its answer.
constexpr std::chrono::seconds kVerdictPatience{3};

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
  out.tokens = tokens_of(config, "configuration");
  return out;
}

FanOut::Limits stream_limits(const config::ConsoleConfig& config) {
  return {kQueueDepth, static_cast<std::size_t>(config.http.most_streams),
          static_cast<std::size_t>(config.http.most_streams_per_viewer)};
}

HttpServer::Options server_options(const config::ConsoleConfig& config) {
  HttpServer::Options out;
  out.address = config.http.address;
  out.port = config.port();
  out.names = config.http.names;
  out.tls = identity_of(config, "configuration");
  out.most_connections = static_cast<std::size_t>(config.http.most_connections);
  out.most_per_peer = static_cast<std::size_t>(config.http.most_connections_per_peer);
  return out;
}

}  // namespace

struct ConsoleService::Impl {
  Impl(host::ServiceHost& host_in, const config::ConsoleConfig& config_in)
      : host(host_in),
        config(config_in),
        http(server_options(config)),
        view({config.common.vehicle, config.common.bus.domain, config.fresh_s}),
        events(stream_limits(config)),
        commands(host.participant()),
        fixes(host.participant()),
        site(site_options(config),
             {[this] { return snapshot(); },
              [this](const std::string& body, const Identity& who, const std::string& peer) {
                return order(body, who, peer);
              },
              [this](const Refusal& refusal, const std::string& peer) { server.refuse(refusal, peer); }},
             events),
        server(
            http,
            [this](const Request& request, const std::string& peer) { return site.answer(request, peer); },
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
    listen_to<FixSample>();
    listen_to<RangeSample>();
    readers.push_back(std::make_shared<bus::Reader<Route>>(
        host.participant(), [this](const Route& route, const auto& info) {
          take(route, host.participant().writer_name(info.writer_guid));
        }));
    exposure = exposure_warning(config);
    if (!exposure.empty()) host.log().warning(exposure);
    listen();
    host.on_status([this](ServiceStatus& status) { fill(status); });
    // Of the host's time: an accelerated vehicle does not make the browsers work more.
    const double period_s = host.clock().rate() / config.updates_hz;
    host.on_tick(from_seconds(period_s), [this] { tick(); });
  }
  ~Impl() { events.close(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// UTC is the vehicle's; ages are what people wait for, on the host's own clock.
  health::Instant now() { return {monotonic.monotonic_ns(), host.clock().utc_ns()}; }

  template <class T>
  void listen_to() {
    readers.push_back(
        std::make_shared<bus::Reader<T>>(host.participant(), [this](const T& sample, const bus::SampleInfo&) {
          if constexpr (std::is_same_v<T, Verdict>) awaited.heard(sample);
          const std::lock_guard lock(mutex);
          view.add(sample, now());
        }));
  }

  /// Any thread of the bus.
  void take(const Route& route, const std::string& writer) {
    std::unique_lock lock(mutex);
    const auto fault = view.add(route, now());
    lock.unlock();
    if (!fault) return;
    if (const auto line = bad_routes.add(*fault, "refused a route from " + writer + ": " + *fault,
                                         monotonic.monotonic_ns()))
      host.log().warning(*line);
  }

  void listen() {
    tried_ns = monotonic.monotonic_ns();
    const std::string trouble = server.start();
    if (trouble.empty()) {
      host.log().info(std::string("console at ") + (http.tls ? "https://" : "http://") + config.http.address +
                      ":" + std::to_string(config.port()) + "/, orders " +
                      (config.access.orders ? "on" : "off"));
    } else if (trouble != said) {
      host.log().error(trouble);
    }
    const std::lock_guard lock(mutex);
    said = trouble;
  }

  void tick() {
    if (!server.running() && monotonic.monotonic_ns() - tried_ns >= kRetryNs) listen();
    std::unique_lock lock(mutex);
    const Tick fresh = view.tick(now());
    lock.unlock();
    if (events.clients() == 0) return;  // the text would be for nobody
    // Written once, whole, and shared: the bytes on the wire are the same for everyone.
    events.publish(std::make_shared<const std::string>("event: tick\ndata: " + tick_json(fresh) + "\n\n"));
  }

  /// Any thread. The history is copied under the lock and written without it: samples do not wait for text.
  std::string snapshot() {
    std::unique_lock lock(mutex);
    const Snapshot taken = view.snapshot();
    lock.unlock();
    return snapshot_json(taken);
  }

  [[nodiscard]] std::optional<health::Departure> departure_of(const Command& order) {
    const std::lock_guard lock(mutex);
    return view.departure_of(order);
  }

  /// Any thread.
  OrderJudgement order(const std::string& body, const Identity& who, const std::string& peer) {
    OrderJudgement judgement = judge_order(body, who, config.access.orders);
    const std::string name = who.name.empty() ? "nobody" : who.name;
    const bool passed_on = judgement.order && pass_on(judgement, name) && judgement.status < 300;
    // Every order of somebody known leaves a line with who and when, also one that was refused; strangers are
    // counted and said now and then, so that they cannot fill the disk. Tokens are never written.
    const std::string line =
        " an order of " + name + " (" + std::string(to_string(who.role)) + ") from " + peer + ": ";
    if (passed_on) {
      ++orders_given;
      const std::string& verdict = judgement.verdict;
      host.log().info("passed on" + line + describe(*judgement.order) +
                      (verdict.empty() ? "" : "; navigation says " + verdict));
    } else {
      ++orders_refused;
      if (who.role != Role::nobody) host.log().warning("refused" + line + judgement.text);
      server.refuse({judgement.status, who.role == Role::nobody ? "order_of_a_stranger" : "order"}, peer);
    }
    return judgement;
  }

  /// Onto the vehicle network; a position that is told goes there as any other measurement does.
  bool pass_on(OrderJudgement& judgement, const std::string& name) {
    if (const auto* told = std::get_if<orders::ToldFix>(&*judgement.order)) {
      const FixSample fix = orders::sample_of(*told, host.header(), host.clock().utc_ns());
      AwaitedVerdicts::Wait wait(awaited, fix.header);
      if (fixes.write(fix)) {
        judgement = judged(std::move(judgement), fix, wait.verdict(kVerdictPatience));
        return true;
      }
      judgement = {503, "The vehicle network did not take the position.", {}};
      return false;
    }
    auto& command = std::get<Command>(*judgement.order);
    command.header = host.header();
    command.header.sensor = std::string_view("console:" + name);
    command.header.sequence = ++sequence;
    const auto departure = departure_of(command);  // before it is set
    if (!commands.write(command)) {
      judgement = {503, "The vehicle network did not take the order.", {}};
      return false;
    }
    judgement.confirm = orders::waits_for_confirmation(command, departure);
    const std::string waiting = orders::waiting_text(command, departure);
    if (judgement.confirm) {
      judgement.text = waiting;
    } else if (!waiting.empty()) {
      judgement.text += " " + waiting;
    }
    return true;
  }

  void say_refused(const Refusal& refusal, const std::string& peer) {
    std::string line = "refused a request from " + peer + ": " + refusal.reason + " (" +
                       std::to_string(refusal.status) + ")";
    if (const auto due = refusals.add(refusal.reason, std::move(line), monotonic.monotonic_ns()))
      host.log().warning(*due);
  }

  void fill(ServiceStatus& status) {
    status.state = ServiceState::healthy;
    {
      const std::lock_guard lock(mutex);
      if (!said.empty()) {
        status.state = ServiceState::degraded;
        status.text = said.substr(0, 240);
      }
      count_refused_routes(status);
    }
    if (http.tls) fill_validity(status);
    if (status.text.empty()) status.text = exposure.substr(0, exposure.find(". ") + 1);
    const HttpServer::Counters counted = server.counters();
    status.counters.push_back({"pages_open", events.clients()});
    status.counters.push_back({"connections", server.connections()});
    status.counters.push_back({"requests", counted.requests});
    status.counters.push_back({"requests_refused", counted.refused});
    status.counters.push_back({"events_dropped", events.dropped()});
    status.counters.push_back({"orders_given", orders_given});
    status.counters.push_back({"orders_refused", orders_refused});
  }

  /// All of them, and each reason that there was. Precondition: mutex held.
  void count_refused_routes(ServiceStatus& status) const {
    std::uint64_t all = 0;
    const auto& refused = view.routes().refused();
    for (std::size_t i = 0; i < refused.size(); ++i) {
      all += refused[i];
      if (refused[i] == 0) continue;
      const std::string name = "routes_refused_" + std::string(RouteBook::word(i));
      status.counters.push_back({std::string_view(name), refused[i]});
    }
    status.counters.push_back({"routes_refused", all});
  }

  /// Said in the life sign while it lasts, and in the log once a day.
  void fill_validity(ServiceStatus& status) {
    const TimeNs utc_ns = monotonic.utc_ns();
    const DurationNs left_ns = std::max<DurationNs>(0, http.tls->valid_until_ns() - utc_ns);
    status.counters.push_back({"certificate_days_left", static_cast<std::uint64_t>(left_ns / kDayNs)});
    const auto note = validity_note(http.tls->valid_from_ns(), http.tls->valid_until_ns(), utc_ns);
    if (!note) return;
    if (!note->usable) status.state = ServiceState::degraded;
    if (status.text.empty()) status.text = note->text;
    const TimeNs now_ns = monotonic.monotonic_ns();
    if (warned_ns && now_ns - *warned_ns < kDayNs) return;
    warned_ns = now_ns;
    note->usable ? host.log().warning(note->text) : host.log().error(note->text);
  }

  host::ServiceHost& host;
  config::ConsoleConfig config;
  HttpServer::Options http;
  std::string exposure;             ///< what is risky about where this listens; empty: nothing
  std::optional<TimeNs> warned_ns;  ///< of the certificate's end; monotonic
  SystemClock monotonic;
  std::mutex mutex;  ///< of the view and of what was said
  VehicleView view;
  std::string said;  ///< why nobody can reach the console; empty: all is well
  TimeNs tried_ns = 0;
  runtime::RefusalLog refusals;
  runtime::RefusalLog bad_routes;
  std::atomic<std::uint64_t> orders_given{0};
  std::atomic<std::uint64_t> orders_refused{0};
  std::atomic<std::uint64_t> sequence{0};
  AwaitedVerdicts awaited;
  FanOut events;
  bus::Writer<Command> commands;
  bus::Writer<FixSample> fixes;
  Site site;
  HttpServer server;
  std::vector<std::shared_ptr<void>> readers;  ///< last: their handlers use all of the above
};

ConsoleService::ConsoleService(host::ServiceHost& host, const config::ConsoleConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}

ConsoleService::~ConsoleService() = default;

}  // namespace fathom::console
