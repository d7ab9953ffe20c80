#include "health/writers/writer_change.hpp"

#include <algorithm>

#include "health/text.hpp"

namespace fathom::health {
namespace {

constexpr double kDescribeS = 1.0;  // what discovery knows of a writer comes a little after its samples

}  // namespace

void WriterChange::note(Stream& stream, const WriterGuid& writer, const Instant& now) {
  if (writer == WriterGuid{}) return;
  const bool first = stream.writer == WriterGuid{};
  if (!first && !of_same_process(writer, stream.writer)) {
    // Of several changes between two reports the first writer is told and the last one that is another.
    if (!stream.changed) {
      stream.before = stream.words;
      stream.first = stream.writer;
    }
    if (!of_same_process(writer, stream.first)) stream.other = writer;
    stream.changed = true;
    stream.described_ns = 0;
  }
  stream.writer = writer;
  stream.last_ns = now.monotonic_ns;
}

void WriterChange::heard_imu(const Name& sensor, const WriterGuid& writer, const Instant& now) {
  auto found = units_.find(sensor);
  if (found == units_.end()) {
    if (units_.size() >= kMostUnits) return;
    found = units_.emplace(sensor, Stream{}).first;
  }
  note(found->second, writer, now);
}

void WriterChange::heard(const NavState& state, const WriterGuid& writer, const Instant& now) {
  note(navigation_, writer, now);
  instance_ = state.header.sensor;
}

void WriterChange::tell(Stream& stream, const Name& key, const std::string& what, AlarmBook& book,
                        const Instant& now, const DescribeWriter& describe) {
  if (stream.writer == WriterGuid{}) return;
  if (stream.described_ns == 0 || to_seconds(now.monotonic_ns - stream.described_ns) >= kDescribeS) {
    stream.words = describe ? describe(stream.writer) : "a writer";
    stream.described_ns = now.monotonic_ns;
  }
  if (!stream.changed || !stream.pace.may_tell(now.monotonic_ns)) return;
  stream.changed = false;
  // Who wrote before may have written last, too: then the one between is news.
  const bool in_turn = of_same_process(stream.writer, stream.first);
  const std::string other = in_turn && describe ? describe(stream.other) : stream.words;
  book.event({.key = key,
              .text = sentence(in_turn ? "%s comes from %.100s in turn with %.100s."
                                       : "%s comes from %.100s now, before it came from %.100s.",
                               what.c_str(), other.c_str(), stream.before.c_str())},
             now);
}

void WriterChange::report(AlarmBook& book, const Instant& now, const DescribeWriter& describe) {
  for (auto& [sensor, stream] : units_)
    tell(stream, alarm_key("imu_writer_changed", sensor.view()), "Inertial unit " + sensor.str(), book, now,
         describe);
  tell(navigation_, "nav_writer_changed", "The navigation state", book, now, describe);
  const bool fresh = navigation_.last_ns != 0 && to_seconds(now.monotonic_ns - navigation_.last_ns) < kFreshS;
  const bool known =
      services_.empty() || std::find(services_.begin(), services_.end(), instance_) != services_.end();
  book.set(fresh && !known,
           {.key = "nav_writer_unexpected",
            .severity = Severity::critical,
            .text = sentence("The navigation state comes from %.100s, and no service %s is expected.",
                             navigation_.words.c_str(), instance_.c_str())},
           now);
}

}  // namespace fathom::health
