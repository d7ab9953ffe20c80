#include "guidance_example/guidance_service.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <fathom/client.hpp>

#include "base/units.hpp"
#include "geo/wgs84.hpp"
#include "guidance_example/line_of_sight.hpp"
#include "guidance_example/mission_route.hpp"
#include "runtime/log.hpp"

namespace fathom::guidance {
namespace {

ClientOptions client_options(const host::ServiceHost& host, const Clock& clock,
                             const config::GuidanceLimits& limits) {
  ClientOptions options;
  const config::CommonConfig& common = host.common();
  options.domain = static_cast<std::uint32_t>(common.bus.domain);
  options.vehicle = common.vehicle;
  options.name = host.name() + "_client";
  options.interfaces = common.bus.interfaces;
  options.peers = common.bus.peers;
  options.discovery_servers = common.bus.discovery_servers;
  options.profiles_dir = common.bus.profiles_dir;
  const std::string& identity = common.bus.security.identity;
  options.security = {common.bus.security.folder, identity.empty() ? host.name() : identity};
  options.clock = &clock;
  options.limits = {limits.max_age_s, limits.max_horizontal_95_m, limits.max_heading_sigma_rad,
                    limits.need_aligned};
  return options;
}

geo::Geodetic place(const NavState& state) {
  return {state.latitude_rad, state.longitude_rad, 0.0};
}

std::string text_of(const SteeringOrder& order, const NavHealth& health) {
  std::array<char, 240> text{};
  std::snprintf(
      text.data(), text.size(),
      "waypoint %zu: %.0f m to go, %.1f m %s of the leg; steer %05.1f deg at %.1f m/s, depth %.1f m; "
      "position known to %.1f m (95 %%)",
      order.waypoint + 1, order.distance_to_go_m, std::abs(order.cross_track_m),
      order.cross_track_m < 0.0 ? "left" : "right", order.heading_rad / kRadPerDeg, order.speed_m_s,
      order.depth_m, health.horizontal_95_m);
  return text.data();
}

}  // namespace

struct GuidanceService::Impl {
  Impl(host::ServiceHost& service_host, const config::GuidanceConfig& guidance_config)
      : host(service_host),
        config(guidance_config),
        client(client_options(host, host.clock(), config.limits)) {
    client.on_nav_state([this](const NavState&) { states.fetch_add(1, std::memory_order_relaxed); });
    host.on_tick(from_seconds(1.0 / config.rate_hz), [this] { tick(); });
    host.on_status([this](ServiceStatus& status) { fill(status); });
  }

  void tick() {
    const NavHealth health = client.health();
    reason = health.reason;
    if (!health.ok) {
      ++holds;
      // Before navigation is up there is nothing to warn of.
      said.say(host.log(), steered ? runtime::LogLevel::warning : runtime::LogLevel::info, "hold",
               "not steering: " + health.reason);
      return;
    }
    said.say(host.log(), runtime::LogLevel::info, "steer", "navigation can be relied on: steering");
    steered = true;
    steer(*client.latest(), health);
  }

  void steer(const NavState& state, const NavHealth& health) {
    if (!path) {
      origin = place(state);
      path.emplace(path_points(),
                   LineOfSight::Options{config.lookahead_m, config.acceptance_m, config.repeat});
    }
    const auto offset = geo::difference_N(origin, place(state));
    order = path->steer(
        {offset.x(), offset.y(), state.velocity_N_m_s[0], state.velocity_N_m_s[1], state.rpy_rad[2]});
    ++orders;
    if (orders == 1 || order.reached != reported_waypoints) show_route();
    const TimeNs now_ns = host.clock().monotonic_ns();
    const bool arrived = order.reached != reported_waypoints;
    if (arrived) {
      host.log().info("waypoint reached, " + std::to_string(order.reached) + " so far" +
                      (order.finished ? "; that was the last one" : ""));
      reported_waypoints = order.reached;
    }
    if (!order.finished && (arrived || now_ns - reported_ns >= from_seconds(config.report_s))) {
      reported_ns = now_ns;
      host.log().info(text_of(order, health));
    }
  }

  /// Navigation does not depend on what people see: a route that is not taken is said, and steering goes on.
  void show_route() {
    if (mission.empty()) mission = mission_waypoints(config, origin);
    try {
      client.publish_route(route_of(mission, order, origin, config.repeat));
    } catch (const std::exception& error) {
      host.log().warning(error.what());
    }
  }

  [[nodiscard]] std::vector<PathPoint> path_points() const {
    std::vector<PathPoint> points;
    for (const config::Waypoint& waypoint : config.waypoints) {
      PathPoint point{waypoint.north_m, waypoint.east_m, waypoint.depth_m, waypoint.speed_m_s};
      if (config.frame == config::WaypointFrame::geodetic) {
        const auto offset = geo::difference_N(origin, {waypoint.latitude_rad, waypoint.longitude_rad, 0.0});
        point.north_m = offset.x();
        point.east_m = offset.y();
      }
      points.push_back(point);
    }
    return points;
  }

  void fill(ServiceStatus& status) {
    if (!steered) {
      status.state = ServiceState::starting;
    } else {
      status.state = reason.empty() ? ServiceState::healthy : ServiceState::degraded;
    }
    if (!reason.empty()) status.text = "not steering: " + reason;
    const TimeNs now_ns = host.clock().monotonic_ns();
    const std::uint64_t count = states.load(std::memory_order_relaxed);
    if (rated_ns != 0 && now_ns > rated_ns) {
      status.rates.push_back(
          {"nav_state", static_cast<double>(count - rated_states) / to_seconds(now_ns - rated_ns)});
    }
    rated_ns = now_ns;
    rated_states = count;
    status.counters.push_back({"nav_states", count});
    status.counters.push_back({"orders", orders});
    status.counters.push_back({"holds", holds});
    status.counters.push_back({"waypoints_reached", order.reached});
  }

  host::ServiceHost& host;
  config::GuidanceConfig config;
  std::atomic<std::uint64_t> states{0};  ///< counted on the client's thread; all else belongs to run()'s
  runtime::SayOnce said;
  std::string reason;  ///< why it does not steer; empty while it does
  bool steered = false;
  geo::Geodetic origin;
  std::optional<LineOfSight> path;
  std::vector<RouteWaypoint> mission;  ///< what people are shown of it
  SteeringOrder order;
  std::uint64_t orders = 0;
  std::uint64_t holds = 0;
  std::size_t reported_waypoints = 0;
  TimeNs reported_ns = 0;
  TimeNs rated_ns = 0;
  std::uint64_t rated_states = 0;
  Client client;  ///< last: its handler uses the above
};

GuidanceService::GuidanceService(host::ServiceHost& host, const config::GuidanceConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}

GuidanceService::~GuidanceService() = default;

}  // namespace fathom::guidance
