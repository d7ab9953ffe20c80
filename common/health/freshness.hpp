#pragma once

#include <map>
#include <utility>
#include <vector>

#include "health/instant.hpp"
#include "health/instruments/sensor_watch.hpp"
#include "health/writers/service_watch.hpp"

namespace fathom::health {

/// How long what a source said last holds: until the source counts as missing. From then on its silence has
/// an alarm of its own, and nothing else is said of the source.
class Freshness {
 public:
  /// Every sensor is one that nobody expects.
  Freshness() = default;
  Freshness(const std::vector<ExpectedSensor>& sensors, const ServiceWatchConfig& services);

  /// How long this sensor may be silent before it counts as missing.
  [[nodiscard]] double limit_s(SourceKind kind, const Name& name) const;
  /// Whether the sensor that was last heard then speaks at `now`. `at_least_s` may lengthen its limit.
  [[nodiscard]] bool of_sensor(SourceKind kind, const Name& name, TimeNs last_monotonic_ns,
                               const Instant& now, double at_least_s = 0.0) const;
  /// The same of a service, by what it says once a second.
  [[nodiscard]] bool of_service(TimeNs last_monotonic_ns, const Instant& now) const;

 private:
  std::map<std::pair<SourceKind, Name>, double> limits_s_;
  double service_limit_s_ = ServiceWatchConfig{}.missing_s;
};

}  // namespace fathom::health
