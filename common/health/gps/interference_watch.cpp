#include "health/gps/interference_watch.hpp"

#include "health/gps/receivers.hpp"
#include "health/text.hpp"

namespace fathom::health {
namespace {

constexpr double kInterferenceHold_s = 3.0;

void follow(bool active, TimeNs& since_ns, const Instant& now) {
  if (!active) {
    since_ns = 0;
  } else if (since_ns == 0) {
    since_ns = now.monotonic_ns;
  }
}

}  // namespace

bool InterferenceWatch::add(const GpsSample& sample, const Instant& now) {
  const bool believed = sample.spoofing != GpsSpoofing::affirmed;
  auto found = receivers_.find(sample.header.sensor);
  if (found == receivers_.end()) {
    if (receivers_.size() >= kMaxReceivers) return believed;
    found = receivers_.emplace(sample.header.sensor, Receiver{}).first;
  }
  Receiver& receiver = found->second;
  receiver.jamming = sample.jamming;
  receiver.spoofing = sample.spoofing;
  receiver.heard_ns = now.monotonic_ns;
  follow(sample.jamming >= GpsJamming::warning, receiver.jammed_since_ns, now);
  follow(sample.spoofing >= GpsSpoofing::indicated, receiver.spoofed_since_ns, now);
  return believed;
}

void InterferenceWatch::report(AlarmBook& book, const Instant& now) const {
  for (const auto& [name, receiver] : receivers_) {
    const bool heard = fresh_.of_sensor(SourceKind::gps, name, receiver.heard_ns, now);
    const auto ago_s = [&](TimeNs since_ns) {
      return since_ns == 0 ? 0.0 : to_seconds(now.monotonic_ns - since_ns);
    };
    const bool no_fix = receiver.jamming == GpsJamming::critical;
    book.set(heard && receiver.jammed_since_ns != 0,
             {.key = alarm_key("gps_jammed", name.view()),
              .severity = Severity::warning,
              .text = sentence("Receiver %s reports jamming%s.", name.c_str(),
                               no_fix ? " that leaves it no fix" : "; its fixes may be poor"),
              .value = static_cast<double>(receiver.jamming),
              .limit = static_cast<double>(GpsJamming::warning),
              .began_ago_s = ago_s(receiver.jammed_since_ns),
              .clear_hold_s = kInterferenceHold_s},
             now);
    const bool affirmed = receiver.spoofing == GpsSpoofing::affirmed;
    book.set(heard && receiver.spoofed_since_ns != 0,
             {.key = alarm_key("gps_spoofed", name.view()),
              .severity = affirmed ? Severity::critical : Severity::warning,
              .text = affirmed ? sentence("Receiver %s reports that it is spoofed; its fixes count as none.",
                                          name.c_str())
                               : sentence("Receiver %s reports signs of spoofing.", name.c_str()),
              .value = static_cast<double>(receiver.spoofing),
              .limit = static_cast<double>(GpsSpoofing::indicated),
              .began_ago_s = ago_s(receiver.spoofed_since_ns),
              .clear_hold_s = kInterferenceHold_s},
             now);
  }
}

}  // namespace fathom::health
