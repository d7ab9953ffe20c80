#include "status/view.hpp"

#include <algorithm>
#include <tuple>

namespace fathom::status {

std::vector<Alarm> sorted_alarms(const StatusView& view) {
  std::vector<Alarm> alarms;
  for (const auto& [name, alarm] : view.alarms) alarms.push_back(alarm);
  std::stable_sort(alarms.begin(), alarms.end(), [](const Alarm& a, const Alarm& b) {
    return std::tuple(!a.active, b.severity, a.since_ns) < std::tuple(!b.active, a.severity, b.since_ns);
  });
  return alarms;
}

}  // namespace fathom::status
