#include "health/freshness.hpp"

#include <algorithm>

namespace fathom::health {

Freshness::Freshness(const std::vector<ExpectedSensor>& sensors, const ServiceWatchConfig& services)
    : service_limit_s_(services.missing_s) {
  for (const ExpectedSensor& sensor : sensors)
    limits_s_.emplace(std::pair(sensor.kind, sensor.name), limits_of(sensor).missing_s);
}

double Freshness::limit_s(SourceKind kind, const Name& name) const {
  const auto found = limits_s_.find({kind, name});
  return found == limits_s_.end() ? limits_of_unexpected().missing_s : found->second;
}

bool Freshness::of_sensor(SourceKind kind, const Name& name, TimeNs last_monotonic_ns, const Instant& now,
                          double at_least_s) const {
  return to_seconds(now.monotonic_ns - last_monotonic_ns) < std::max(limit_s(kind, name), at_least_s);
}

bool Freshness::of_service(TimeNs last_monotonic_ns, const Instant& now) const {
  return to_seconds(now.monotonic_ns - last_monotonic_ns) < service_limit_s_;
}

}  // namespace fathom::health
