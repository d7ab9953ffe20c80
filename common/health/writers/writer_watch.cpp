#include "health/writers/writer_watch.hpp"

#include <algorithm>

#include "health/text.hpp"

namespace fathom::health {
namespace {

constexpr std::size_t kMaxSensors = 64;  // names come from the network: bounded

}  // namespace

void WriterWatch::heard(SourceKind kind, const Name& name, const WriterGuid& writer, const Instant& now) {
  // Anybody may tell a position in the name of an operator.
  if (writer == WriterGuid{} || kind == SourceKind::fix) return;
  auto found = sensors_.find({kind, name});
  if (found == sensors_.end()) {
    if (sensors_.size() >= kMaxSensors) return;
    found = sensors_.emplace(std::pair(kind, name), Sensor{}).first;
    const auto of_kind = [&](const auto& entry) { return entry.first == kind; };
    found->second.expected =
        std::none_of(expected_.begin(), expected_.end(), of_kind) ||
        std::find(expected_.begin(), expected_.end(), std::pair(kind, name)) != expected_.end();
    found->second.first_ns = now.monotonic_ns;
  }
  Sensor& sensor = found->second;
  ++sensor.samples;
  auto& writers = sensor.writers;
  auto known = std::find_if(writers.begin(), writers.end(), [&](const Writer& w) { return w.id == writer; });
  if (known == writers.end()) {
    if (writers.size() >= kMaxWriters) {
      writers.erase(std::min_element(writers.begin(), writers.end(),
                                     [](const Writer& a, const Writer& b) { return a.order < b.order; }));
    }
    writers.push_back({writer, now.monotonic_ns, sensor.samples});
    return;
  }
  const bool recent = to_seconds(now.monotonic_ns - known->last_ns) < kWindowS;
  if (recent && sensor.samples - known->order > 1) {
    const auto other =
        std::max_element(writers.begin(), writers.end(), [&](const Writer& a, const Writer& b) {
          return (a.id == writer ? 0 : a.order) < (b.id == writer ? 0 : b.order);
        });
    note_return(sensor, other->id, writer, now);
  }
  known->last_ns = now.monotonic_ns;
  known->order = sensor.samples;
}

void WriterWatch::note_return(Sensor& sensor, const WriterGuid& other, const WriterGuid& again,
                              const Instant& now) const {
  const bool fresh = sensor.returns > 0 && to_seconds(now.monotonic_ns - sensor.returned_ns) < kWindowS;
  sensor.returns = fresh ? sensor.returns + 1 : 1;
  sensor.returned_ns = now.monotonic_ns;
  // The one that was there first is named first.
  const bool other_first = std::find_if(sensor.writers.begin(), sensor.writers.end(), [&](const Writer& w) {
                             return w.id == other || w.id == again;
                           })->id == other;
  sensor.rivals = other_first ? std::array{other, again} : std::array{again, other};
}

void WriterWatch::report(AlarmBook& book, const Instant& now, const DescribeWriter& describe) const {
  const auto who = [&](const WriterGuid& id) { return describe ? describe(id) : std::string("a writer"); };
  for (const auto& [id, sensor] : sensors_) {
    const Name key = alarm_key("second_writer", id.second.view());
    const std::string kind(to_string(id.first));
    const auto within = [&](TimeNs then) { return to_seconds(now.monotonic_ns - then) < kWindowS; };
    Condition condition;
    condition.key = key;
    if (sensor.returns >= 2 && within(sensor.returned_ns)) {
      condition.text = sentence("Sensor %s (%s) is written by two: %s and %s.", id.second.c_str(),
                                kind.c_str(), who(sensor.rivals[0]).c_str(), who(sensor.rivals[1]).c_str());
      book.hold(condition, now);
    } else if (!sensor.expected && sensor.samples >= 2 && within(sensor.writers.back().last_ns)) {
      condition.text = sentence("%s publishes %s measurements as sensor %s, which nobody expects.",
                                who(sensor.writers.back().id).c_str(), kind.c_str(), id.second.c_str());
      condition.began_ago_s = to_seconds(now.monotonic_ns - sensor.first_ns);
      book.hold(condition, now);
    } else {
      book.release(key, now);
    }
  }
}

}  // namespace fathom::health
