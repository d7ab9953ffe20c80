#include "health/instruments/sensor_watch.hpp"

#include <algorithm>

#include "health/text.hpp"

namespace fathom::health {

StreamLimits limits_of(const ExpectedSensor& sensor) {
  StreamLimits limits = StreamLimits::from_rate(sensor.rate_hz);
  if (sensor.missing_s > 0.0) {
    limits.missing_s = sensor.missing_s;
    limits.stale_s = std::min(limits.stale_s, sensor.missing_s);
  }
  return limits;
}

StreamLimits limits_of_unexpected() {
  return {kUnknown, 5.0, 20.0, 1};
}

SensorWatch::SensorWatch(const std::vector<ExpectedSensor>& expected, double startup_s, const Instant& start)
    : startup_s_(startup_s), start_(start) {
  for (const ExpectedSensor& sensor : expected) {
    if (sensors_.size() >= kMaxSensors) break;
    index_.emplace(std::pair(sensor.kind, sensor.name), sensors_.size());
    sensors_.push_back({sensor, true, StreamWatch(limits_of(sensor), start.monotonic_ns)});
  }
}

void SensorWatch::heard(SourceKind kind, const Name& name, const Instant& now) {
  auto found = index_.find({kind, name});
  if (found == index_.end()) {
    if (sensors_.size() >= kMaxSensors) return;
    found = index_.emplace(std::pair(kind, name), sensors_.size()).first;
    ExpectedSensor what;
    what.name = name;
    what.kind = kind;
    sensors_.push_back({what, false, StreamWatch(limits_of_unexpected(), now.monotonic_ns)});
  }
  sensors_[found->second].stream.heard(now.monotonic_ns);
}

void SensorWatch::evaluate(const Instant& now) {
  for (Sensor& sensor : sensors_) sensor.stream.evaluate(now.monotonic_ns);
}

bool SensorWatch::all_heard() const {
  return std::all_of(sensors_.begin(), sensors_.end(),
                     [](const Sensor& sensor) { return !sensor.expected || sensor.stream.ever_heard(); });
}

void SensorWatch::report(AlarmBook& book, const Instant& now) const {
  for (const Sensor& sensor : sensors_) {
    if (!sensor.expected) continue;
    const StreamWatch& stream = sensor.stream;
    const bool unseen = !stream.ever_heard();
    const double limit_s =
        unseen ? std::max(startup_s_, stream.limits().missing_s) : stream.limits().missing_s;
    const double silent_s = stream.outage_s(now.monotonic_ns);
    const Name& name = sensor.what.name;
    book.set(unseen ? silent_s > limit_s : stream.presence() == Presence::missing,
             {.key = alarm_key("sensor_missing", name.view()),
              .severity = sensor.what.severity,
              .text = sentence("Nothing was heard from sensor %s for %s%s (limit %s).", name.c_str(),
                               duration_text(silent_s).c_str(), unseen ? ", never since the start" : "",
                               duration_text(limit_s).c_str()),
              .value = silent_s,
              .limit = limit_s,
              .began_ago_s = silent_s},
             now);
    const double rate_hz = stream.rate_hz(now.monotonic_ns);
    book.set(stream.slow(),
             {.key = alarm_key("sensor_slow", name.view()),
              .severity = Severity::notice,
              .text = sentence("Sensor %s gives %.3g samples a second instead of %.3g.", name.c_str(),
                               rate_hz, sensor.what.rate_hz),
              .value = rate_hz,
              .limit = 0.5 * sensor.what.rate_hz},
             now);
  }
}

std::vector<WatchedItem> SensorWatch::items(const Instant& now) const {
  std::vector<WatchedItem> items;
  items.reserve(sensors_.size());
  for (const Sensor& sensor : sensors_) {
    items.push_back({sensor.what.name, sensor.stream.presence(), sensor.stream.age_s(now.monotonic_ns),
                     sensor.stream.rate_hz(now.monotonic_ns)});
  }
  return items;
}

}  // namespace fathom::health
