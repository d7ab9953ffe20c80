#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// A place that guidance passes through, WGS-84.
struct RouteWaypoint {
  Name name{};  ///< empty: people call it by its number
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double depth_m = kUnknown;    ///< below the surface, on the way there
  double speed_m_s = kUnknown;  ///< on the way there
};

/// The waypoints that a program follows, for the people who watch it. header.sensor is the publisher's name
/// and, with the vehicle, the key.
struct Route {
  static constexpr std::size_t kMostWaypoints = 64;
  SampleHeader header{};
  std::uint32_t active = 0;  ///< index of the one steered to; as many as there are: the last one is passed
  bool repeats = false;      ///< after the last waypoint comes the first
  std::uint32_t first_number = 1;   ///< of waypoints[0] within the mission: a long mission shows a part
  std::uint32_t mission_count = 0;  ///< waypoints of the whole mission; 0: as many as there are here
  double leg_start_latitude_rad = kUnknown;  ///< where the leg to the active waypoint began
  double leg_start_longitude_rad = kUnknown;
  std::vector<RouteWaypoint> waypoints{};  ///< at most kMostWaypoints; none: it follows nothing
};

/// Why a route cannot be drawn or believed, as a word for counting.
enum class RouteFault : std::uint8_t {
  none = 0,
  publisher = 1,  ///< it has no name
  length = 2,     ///< more than kMostWaypoints, or the mission is shorter than the part
  active = 3,     ///< beyond the waypoints
  position = 4,   ///< not finite, latitude beyond a pole, longitude beyond (-360, 360) degrees, half known
  motion = 5,     ///< depth or speed infinite, or beyond what any vehicle of this kind does
  name = 6,       ///< control characters in a name
};
inline constexpr std::size_t kRouteFaults = 7;
[[nodiscard]] std::string_view to_string(RouteFault fault);
/// What was expected of it, one phrase; empty for none.
[[nodiscard]] std::string_view expectation(RouteFault fault);

/// The first fault of a route: what is published is checked by the same rules as what is received.
[[nodiscard]] RouteFault fault_of(const Route& route);

/// The two say the same, whoever said it and when.
[[nodiscard]] bool same_intent(const Route& a, const Route& b);

}  // namespace fathom
