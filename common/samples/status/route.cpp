#include "samples/status/route.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fathom {
namespace {

// Deeper than any ocean, higher and faster than any vehicle that navigates with this.
constexpr double kDeepest_m = 12000.0;
constexpr double kHighest_m = 50000.0;
constexpr double kFastest_m_s = 1000.0;

constexpr std::array<std::string_view, kRouteFaults> kWords{"none",     "publisher", "length", "active",
                                                            "position", "motion",    "name"};
constexpr std::array<std::string_view, kRouteFaults> kExpectations{
    "",
    "a publisher with a name",
    "at most 64 waypoints, numbered from 1, and no more than the whole mission has",
    "the active waypoint among those given, or one behind the last",
    "latitudes and longitudes that are finite and on the Earth",
    "depths of -50000 to 12000 m and speeds of 0 to 1000 m/s, or unknown",
    "names without control characters"};

bool on_earth(double latitude_rad, double longitude_rad) {
  // False for NaN and infinities.
  return std::abs(latitude_rad) <= std::numbers::pi / 2.0 && std::abs(longitude_rad) < 2.0 * std::numbers::pi;
}

bool within(double value, double low, double high) {
  return !known(value) || (value >= low && value <= high);
}

bool plain(const Name& name) {
  const std::string_view text = name.view();
  return std::none_of(text.begin(), text.end(),
                      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\x7f'; });
}

bool same_value(double a, double b) {
  return a == b || (!known(a) && !known(b));
}

bool same_waypoint(const RouteWaypoint& a, const RouteWaypoint& b) {
  return a.name == b.name && same_value(a.latitude_rad, b.latitude_rad) &&
         same_value(a.longitude_rad, b.longitude_rad) && same_value(a.depth_m, b.depth_m) &&
         same_value(a.speed_m_s, b.speed_m_s);
}

}  // namespace

std::string_view to_string(RouteFault fault) {
  const auto index = static_cast<std::size_t>(fault);
  return index < kWords.size() ? kWords[index] : std::string_view("unknown");
}

std::string_view expectation(RouteFault fault) {
  const auto index = static_cast<std::size_t>(fault);
  return index < kExpectations.size() ? kExpectations[index] : std::string_view();
}

RouteFault fault_of(const Route& route) {
  const std::size_t count = route.waypoints.size();
  if (route.header.sensor.empty()) return RouteFault::publisher;
  if (count > Route::kMostWaypoints || route.first_number == 0) return RouteFault::length;
  if (route.mission_count != 0 &&
      std::uint64_t{route.first_number} + count > std::uint64_t{route.mission_count} + 1) {
    return RouteFault::length;
  }
  if (route.active > count) return RouteFault::active;
  if (!plain(route.header.sensor)) return RouteFault::name;
  const bool start_unknown = !known(route.leg_start_latitude_rad) && !known(route.leg_start_longitude_rad);
  if (!start_unknown && !on_earth(route.leg_start_latitude_rad, route.leg_start_longitude_rad)) {
    return RouteFault::position;
  }
  for (const RouteWaypoint& point : route.waypoints) {
    if (!on_earth(point.latitude_rad, point.longitude_rad)) return RouteFault::position;
    if (!within(point.depth_m, -kHighest_m, kDeepest_m)) return RouteFault::motion;
    if (!within(point.speed_m_s, 0.0, kFastest_m_s)) return RouteFault::motion;
    if (!plain(point.name)) return RouteFault::name;
  }
  return RouteFault::none;
}

bool same_intent(const Route& a, const Route& b) {
  return a.active == b.active && a.repeats == b.repeats && a.first_number == b.first_number &&
         a.mission_count == b.mission_count &&
         same_value(a.leg_start_latitude_rad, b.leg_start_latitude_rad) &&
         same_value(a.leg_start_longitude_rad, b.leg_start_longitude_rad) &&
         std::equal(a.waypoints.begin(), a.waypoints.end(), b.waypoints.begin(), b.waypoints.end(),
                    same_waypoint);
}

}  // namespace fathom
