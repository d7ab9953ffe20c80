#include "console/view/route_book.hpp"

#include <algorithm>
#include <utility>

namespace fathom::console {
std::string_view RouteBook::word(std::size_t index) {
  return index == kTooMany ? "too_many" : to_string(static_cast<RouteFault>(index));
}

std::optional<std::string> RouteBook::add(const Route& route, const health::Instant& at) {
  if (const RouteFault fault = fault_of(route); fault != RouteFault::none) {
    ++refused_[static_cast<std::size_t>(fault)];
    return "its " + std::string(to_string(fault)) + " is not usable, expected " +
           std::string(expectation(fault));
  }
  const auto known_one = routes_.find(route.header.sensor);
  if (known_one != routes_.end()) {
    changed_ = changed_ || !same_intent(known_one->second.route, route);
    known_one->second = {route, at.monotonic_ns};
    return std::nullopt;
  }
  forget(at.monotonic_ns);
  if (routes_.size() >= kMostRoutes) {
    ++refused_[kTooMany];
    return "there are " + std::to_string(routes_.size()) + " routes already, expected no more";
  }
  // The first one may have waited on the network for who knows how long; those after it come as they are
  // said. A stamp from the future is a clock's fault, not the route's age.
  const double waited_s = to_seconds(at.utc_ns) - to_seconds(route.header.stamp_ns);
  routes_[route.header.sensor] = {route,
                                  at.monotonic_ns - from_seconds(std::clamp(waited_s, 0.0, kForgottenS))};
  changed_ = true;
  return std::nullopt;
}

void RouteBook::forget(TimeNs monotonic_ns) {
  const auto gone = [&](const auto& entry) {
    return to_seconds(monotonic_ns - entry.second.at_ns) > kForgottenS;
  };
  std::erase_if(routes_, gone);
}

bool RouteBook::take_changed() {
  return std::exchange(changed_, false);
}

std::vector<RouteLine> RouteBook::lines(const health::Instant& at) {
  forget(at.monotonic_ns);
  std::vector<RouteLine> out;
  for (const auto& [name, heard] : routes_) {
    if (heard.route.waypoints.empty()) continue;
    const double age_s = to_seconds(at.monotonic_ns - heard.at_ns);
    out.push_back({heard.route, age_s, age_s > kOldS});
  }
  return out;
}

}  // namespace fathom::console
