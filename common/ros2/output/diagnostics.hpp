#pragma once

#include <map>
#include <optional>
#include <string>

#include "base/time.hpp"
#include "ros2/messages/graph.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"

namespace fathom::ros2 {

/// What the vehicle says of itself, as diagnostics of ROS 2: one status for navigation, one for each service
/// and one for each alarm that is active. Times are those of the vehicle's clock. Not thread-safe.
class DiagnosticsBook {
 public:
  /// A life sign is published once a second; older than this it is stale.
  static constexpr DurationNs kStale_ns = 3 * kNsPerSecond;
  /// One message holds at most so many of each.
  static constexpr std::size_t kMost = 48;

  void heard(const ServiceStatus& status, TimeNs now_ns);
  void heard(const Alarm& alarm);
  void heard(const NavState& state, TimeNs now_ns);

  [[nodiscard]] DiagnosticArray message(const std::string& vehicle, TimeNs now_ns) const;

 private:
  template <class T>
  struct Heard {
    T value;
    TimeNs at_ns = 0;
  };
  std::map<std::string, Heard<ServiceStatus>> services_;
  std::map<std::string, Alarm> alarms_;
  std::optional<Heard<NavState>> state_;
};

}  // namespace fathom::ros2
