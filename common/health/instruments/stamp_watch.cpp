#include "health/instruments/stamp_watch.hpp"

#include <algorithm>
#include <cmath>

#include "health/text.hpp"

namespace fathom::health {
namespace {

constexpr std::size_t kMaxNames = 64;  // names come from the network: bounded
constexpr int kFewestInTurn = 3;
constexpr double kLastingS = 2.0;
constexpr double kDisbeliefHoldS = 5.0;  // a receiver that just woke does not know the date yet

}  // namespace

void StampWatch::heard(SourceKind kind, const SampleHeader& header, const Instant& now) {
  auto found = sensors_.find({kind, header.sensor});
  if (found == sensors_.end()) {
    if (sensors_.size() >= kMaxNames) return;
    found = sensors_.emplace(std::pair(kind, header.sensor), Sensor{}).first;
  }
  Sensor& sensor = found->second;
  if (sensor.heard && header.stamp_ns == sensor.last_stamp_ns) count_repeat(sensor, now);
  sensor.heard = true;
  sensor.heard_ns = now.monotonic_ns;
  sensor.last_stamp_ns = header.stamp_ns;
  follow_age(sensor, to_seconds(now.utc_ns - header.stamp_ns), now);
}

void StampWatch::count_repeat(Sensor& sensor, const Instant& now) const {
  const bool within =
      sensor.repeats > 0 && to_seconds(now.monotonic_ns - sensor.repeated_ns) < config_.window_s;
  if (!within) {
    sensor.repeats = 0;
    sensor.repeats_since_ns = now.monotonic_ns;
  }
  ++sensor.repeats;
  sensor.repeated_ns = now.monotonic_ns;
}

void StampWatch::follow_age(Sensor& sensor, double age_s, const Instant& now) const {
  sensor.age_s = age_s;
  sensor.ahead = age_s < -config_.clock_jump_s ? std::min(sensor.ahead + 1, kFewestInTurn) : 0;
  if (!sensor.aged) {
    sensor.aged = true;
    sensor.low_s = sensor.high_s = age_s;
    return;
  }
  const double limit_s = config_.clock_jump_s;
  if (age_s > sensor.low_s - limit_s && age_s < sensor.high_s + limit_s) {
    sensor.low_s = std::min(sensor.low_s, age_s);
    sensor.high_s = std::max(sensor.high_s, age_s);
    sensor.beyond = 0;
    return;
  }
  if (sensor.beyond == 0) {
    sensor.beyond_since_ns = now.monotonic_ns;
    sensor.beyond_low_s = sensor.beyond_high_s = age_s;
  }
  sensor.beyond_low_s = std::min(sensor.beyond_low_s, age_s);
  sensor.beyond_high_s = std::max(sensor.beyond_high_s, age_s);
  ++sensor.beyond;
  if (sensor.beyond < kFewestInTurn || to_seconds(now.monotonic_ns - sensor.beyond_since_ns) < kLastingS)
    return;
  const bool together = sensor.beyond_high_s - sensor.beyond_low_s < 0.5 * limit_s;
  const bool one_side = sensor.beyond_low_s > sensor.high_s || sensor.beyond_high_s < sensor.low_s;
  if (together && one_side) {
    // The clock behind the stamps went forward when samples became younger.
    sensor.jumped_s = sensor.beyond_low_s > sensor.high_s ? sensor.high_s - sensor.beyond_low_s
                                                          : sensor.low_s - sensor.beyond_high_s;
    sensor.low_s = sensor.beyond_low_s;
    sensor.high_s = sensor.beyond_high_s;
  } else {
    sensor.low_s = std::min(sensor.low_s, sensor.beyond_low_s);
    sensor.high_s = std::max(sensor.high_s, sensor.beyond_high_s);
  }
  sensor.beyond = 0;
}

void StampWatch::add(const ServiceStatus& status, const Instant& now) {
  auto found = bridges_.find(status.header.sensor);
  if (found == bridges_.end()) {
    if (bridges_.size() >= kMaxNames) return;
    found = bridges_.emplace(status.header.sensor, Bridge{}).first;
  }
  Bridge& bridge = found->second;
  const std::uint64_t steps = status.counter("time_steps");
  const std::uint64_t implausible = status.counter("time_implausible");
  const bool disbelieves = bridge.known && implausible > bridge.implausible;
  if (bridge.known && steps > bridge.steps) bridge.stepped = true;
  if (disbelieves && !bridge.disbelieved) bridge.disbelieved_since_ns = now.monotonic_ns;
  bridge.disbelieved = disbelieves;
  bridge.known = true;
  bridge.heard_ns = now.monotonic_ns;
  bridge.steps = steps;
  bridge.implausible = implausible;
}

void StampWatch::report(AlarmBook& book, const Instant& now) {
  for (auto& [id, sensor] : sensors_) {
    const char* name = id.second.c_str();
    const bool repeats = sensor.repeats >= config_.duplicates &&
                         to_seconds(now.monotonic_ns - sensor.repeated_ns) < config_.window_s;
    const double repeats_for_s = to_seconds(now.monotonic_ns - sensor.repeats_since_ns);
    const Name repeats_key = alarm_key("duplicate_stamps", id.second.view());
    if (repeats) {
      book.hold({.key = repeats_key,
                 .severity = Severity::warning,
                 .text = sentence("Sensor %s gave %d samples the stamp of the one before them within %s.",
                                  name, sensor.repeats, duration_text(repeats_for_s).c_str()),
                 .value = static_cast<double>(sensor.repeats),
                 .limit = static_cast<double>(config_.duplicates),
                 .began_ago_s = repeats_for_s},
                now);
    } else {
      book.release(repeats_key, now);
    }
    if (sensor.jumped_s != 0.0) {
      book.event({.key = alarm_key("clock_jump", id.second.view()),
                  .severity = Severity::warning,
                  .text = sentence("The clock behind sensor %s jumped %s by %s.", name,
                                   sensor.jumped_s > 0.0 ? "forward" : "back",
                                   duration_text(std::abs(sensor.jumped_s)).c_str()),
                  .value = sensor.jumped_s,
                  .limit = config_.clock_jump_s},
                 now);
      sensor.jumped_s = 0.0;
    }
    const Name ahead_key = alarm_key("clock_ahead", id.second.view());
    if (sensor.ahead >= kFewestInTurn && fresh_.of_sensor(id.first, id.second, sensor.heard_ns, now)) {
      book.hold({.key = ahead_key,
                 .severity = Severity::warning,
                 .text = sentence("Sensor %s stamps its samples %s ahead of this host's clock.", name,
                                  duration_text(-sensor.age_s).c_str()),
                 .value = -sensor.age_s,
                 .limit = config_.clock_jump_s,
                 .clear_hold_s = 2.0},
                now);
    } else {
      book.release(ahead_key, now);
    }
  }
  report_bridges(book, now);
}

void StampWatch::report_bridges(AlarmBook& book, const Instant& now) {
  for (auto& [name, bridge] : bridges_) {
    const Name key = alarm_key("device_clock", name.view());
    if (bridge.stepped) {
      book.event({.key = key,
                  .severity = Severity::warning,
                  .text = sentence("%s saw the clock of its device jump.", name.c_str())},
                 now);
      bridge.stepped = false;
      continue;
    }
    const bool disbelieved = bridge.disbelieved && fresh_.of_service(bridge.heard_ns, now);
    const double for_s = disbelieved ? to_seconds(now.monotonic_ns - bridge.disbelieved_since_ns) : 0.0;
    if (disbelieved && for_s >= kDisbeliefHoldS) {
      book.hold({.key = key,
                 .severity = Severity::warning,
                 .text = sentence("The device of %s has told a time that cannot be for %s; its samples are "
                                  "stamped on arrival.",
                                  name.c_str(), duration_text(for_s).c_str()),
                 .value = for_s,
                 .limit = kDisbeliefHoldS,
                 .began_ago_s = for_s,
                 .clear_hold_s = 2.0},
                now);
    } else if (!disbelieved) {
      book.release(key, now);
    }
  }
}

}  // namespace fathom::health
