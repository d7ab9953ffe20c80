#include "status/judgement.hpp"

#include <cmath>

#include "health/text.hpp"
#include "samples/position/gives_position.hpp"

namespace fathom::status {
namespace {

constexpr double kNavFresh_s = 1.0;
constexpr double kMonitorFresh_s = 3.0;
constexpr double kServiceFresh_s = 3.0;

}  // namespace

std::string_view to_string(Condition condition) {
  switch (condition) {
    case Condition::healthy:
      return "healthy";
    case Condition::degraded:
      return "degraded";
    case Condition::no_navigation:
      break;
  }
  return "no_navigation";
}

Judgement judge(const StatusView& view) {
  Judgement out;
  const auto no_navigation = [&out](std::string reason) {
    out.condition = Condition::no_navigation;
    out.reasons.push_back(std::move(reason));
  };
  out.condition = Condition::healthy;
  if (!view.nav) {
    no_navigation("No navigation state was heard.");
  } else {
    const NavState& nav = view.nav->sample;
    if (view.nav->age_s > kNavFresh_s) {
      no_navigation(health::sentence("The last navigation state is %.1f s old.", view.nav->age_s));
    } else if (!gives_position(nav.mode)) {
      no_navigation("There is no position yet: mode " + std::string(to_string(nav.mode)) + ".");
    } else if (!std::isfinite(nav.latitude_rad) || !std::isfinite(nav.longitude_rad)) {
      no_navigation("The position is not finite.");
    }
  }
  const auto degraded = [&out](std::string reason) {
    if (out.condition == Condition::healthy) out.condition = Condition::degraded;
    out.reasons.push_back(std::move(reason));
  };
  if (!view.monitor) {
    degraded("The monitor was not heard.");
  } else if (view.monitor->age_s > kMonitorFresh_s) {
    degraded(health::sentence("The monitor was last heard %.1f s ago.", view.monitor->age_s));
  } else if (!view.monitor->sample.known) {
    degraded("The monitor has just been started and does not know yet.");
  } else if (!view.monitor->sample.healthy && view.monitor->sample.alarms_active == 0) {
    degraded("The monitor reports that GPS or navigation is not there.");
  } else if (!view.monitor->sample.healthy) {
    degraded(health::sentence("The monitor reports %u active alarms.", view.monitor->sample.alarms_active));
  }
  for (const auto& [name, heard] : view.services) {
    if (heard.age_s > kServiceFresh_s) {
      degraded(health::sentence("Service %s was last heard %.1f s ago.", name.c_str(), heard.age_s));
    } else if (heard.sample.state == ServiceState::degraded) {
      degraded("Service " + name.str() + " is degraded: " + heard.sample.text);
    }
  }
  return out;
}

}  // namespace fathom::status
