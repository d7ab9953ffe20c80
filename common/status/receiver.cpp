#include "status/receiver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "health/text.hpp"

namespace fathom::status {
namespace {

using health::duration_text;
using health::sentence;

constexpr double kSpeaksS = 10.0;  // a verdict that is older says nothing of now

/// For how long that alarm has been active, by the clock of the monitor, which stamped it.
std::optional<double> active_for_s(const StatusView& view, const char* kind, const Name& receiver) {
  const auto found = view.alarms.find(health::alarm_key(kind, receiver.view()));
  if (found == view.alarms.end() || !found->second.active) return std::nullopt;
  const auto& [monitor, age_s] = *view.monitor;
  return std::max(0.0, to_seconds(monitor.header.stamp_ns - found->second.since_ns) + age_s);
}

/// How long nothing has come from it; nothing when it speaks or nobody knows.
std::optional<double> silent_s(const StatusView& view, const Name& receiver) {
  const auto& sensors = view.monitor->sample.sensors;
  const auto found = std::find_if(sensors.begin(), sensors.end(),
                                  [&](const WatchedItem& item) { return item.name == receiver; });
  if (found == sensors.end() || found->presence == Presence::present) return std::nullopt;
  return found->age_s + view.monitor->age_s;
}

/// How near a receiver is to a usable fix. One that has a fix needs no surface; one that is only under water
/// does, whatever is wrong with another.
int rank(ReceiverTrouble trouble) {
  switch (trouble) {
    case ReceiverTrouble::disputed:
      return 0;
    case ReceiverTrouble::refused:
      return 1;
    case ReceiverTrouble::no_fix:
      return 2;
    case ReceiverTrouble::frozen:
      return 3;
    case ReceiverTrouble::disabled:
      return 4;
    case ReceiverTrouble::silent:
      break;
  }
  return 5;
}

}  // namespace

bool is_refused_fix(VerdictKind kind) {
  return kind == VerdictKind::rejected || kind == VerdictKind::disputed || kind == VerdictKind::frozen ||
         kind == VerdictKind::unknown_frame || kind == VerdictKind::from_the_future ||
         kind == VerdictKind::late;
}

ReceiverWord why_out(const StatusView& view, const ReceiverOutage& receiver) {
  const Name& name = receiver.name;
  if (const auto for_s = silent_s(view, name)) return {name, ReceiverTrouble::silent, *for_s};
  const auto found = view.verdicts.find(name);
  const bool judged = found != view.verdicts.end() && found->second.last_age_s < kSpeaksS;
  const VerdictCounts verdict = judged ? found->second : VerdictCounts{};
  const VerdictKind last = verdict.last;
  if (last == VerdictKind::source_disabled) return {name, ReceiverTrouble::disabled};
  if (judged && !is_refused_fix(last)) return {name};
  // A view that began a moment ago knows for how long by the alarm alone.
  const auto word = [&](ReceiverTrouble trouble, std::optional<double> alarm_s) {
    return ReceiverWord{name, trouble, std::max(verdict.refused_for_s, alarm_s.value_or(0.0)), last};
  };
  const auto refused_s = active_for_s(view, "refused", name);
  const auto disputed_s = active_for_s(view, "gps_disputed", name);
  const auto frozen_s = active_for_s(view, "gps_frozen", name);
  if (disputed_s || last == VerdictKind::disputed)
    return word(ReceiverTrouble::disputed, std::max(disputed_s, refused_s));
  if (frozen_s || last == VerdictKind::frozen) return word(ReceiverTrouble::frozen, frozen_s);
  if (refused_s || judged) return word(ReceiverTrouble::refused, refused_s);
  return {name};
}

ReceiverWord why_no_gps(const StatusView& view) {
  std::optional<ReceiverWord> nearest;
  for (const ReceiverOutage& receiver : view.monitor->sample.receivers) {
    if (!receiver.active) continue;  // the vehicle is out all the same: this one does not count
    const ReceiverWord word = why_out(view, receiver);
    if (!nearest || rank(word.trouble) < rank(nearest->trouble)) nearest = word;
  }
  return nearest.value_or(ReceiverWord{});
}

std::string ReceiverWord::phrase() const {
  const std::string time = std::isfinite(for_s) ? " for " + duration_text(for_s) : std::string();
  switch (trouble) {
    case ReceiverTrouble::refused:
    case ReceiverTrouble::disputed:
      return name.str() + " has a fix that navigation has refused" + time;
    case ReceiverTrouble::frozen:
      return name.str() + " has repeated one fix" + time;
    case ReceiverTrouble::disabled:
      return name.str() + " is disabled";
    case ReceiverTrouble::silent:
      return name.str() + " has been silent" + time;
    case ReceiverTrouble::no_fix:
      break;
  }
  return "";
}

std::string ReceiverWord::advice() const {
  const char* const who = name.c_str();
  switch (trouble) {
    case ReceiverTrouble::disputed:
      return sentence(
          "%s or navigation is far wrong: compare with another position, then disable %s or set "
          "the position.",
          who, who);
    case ReceiverTrouble::refused:
      if (as == VerdictKind::late || as == VerdictKind::from_the_future)
        return sentence("Look at the clock behind %s and at its link: its fixes are refused as %s.", who,
                        std::string(to_string(as)).c_str());
      return sentence(
          "Compare %s with another position: where it is right set the position, where it is "
          "wrong disable it.",
          who);
    case ReceiverTrouble::frozen:
      return sentence("Restart %s: it repeats itself wherever the vehicle is.", who);
    case ReceiverTrouble::disabled:
      return sentence("Enable %s, or get a USBL fix before the limit is passed.", who);
    case ReceiverTrouble::silent:
      return sentence("Look at the cable, port and bridge of %s: at the surface it stays silent, too.", who);
    case ReceiverTrouble::no_fix:
      break;
  }
  return "";
}

}  // namespace fathom::status
