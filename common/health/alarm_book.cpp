#include "health/alarm_book.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

namespace fathom::health {
namespace {

void describe(Alarm& alarm, const Condition& condition) {
  alarm.text = condition.text;
  alarm.value = condition.value;
  alarm.limit = condition.limit;
}

}  // namespace

std::string_view to_string(AlarmEvent event) {
  switch (event) {
    case AlarmEvent::restored:
      return "restored";
    case AlarmEvent::raised:
      return "raised";
    case AlarmEvent::worsened:
      return "worsened";
    case AlarmEvent::cleared:
      return "cleared";
    case AlarmEvent::acknowledged:
      break;
  }
  return "acknowledged";
}

std::optional<AlarmEvent> AlarmBook::hold(const Condition& condition, const Instant& now) {
  auto found = entries_.find(condition.key);
  if (found == entries_.end()) {
    if (!make_room(condition.severity)) {
      ++dropped_;
      return std::nullopt;
    }
    found = entries_.emplace(condition.key, Entry{}).first;
    found->second.alarm.header.vehicle = vehicle_;
    found->second.alarm.alarm = condition.key;
  }
  Entry& entry = found->second;
  Alarm& alarm = entry.alarm;
  entry.away = false;
  entry.unknown_until_ns = 0;
  entry.clear_hold_s = condition.clear_hold_s;
  describe(alarm, condition);
  if (!alarm.active) {
    alarm.active = true;
    alarm.acknowledged = false;
    alarm.severity = condition.severity;
    alarm.since_ns = now.utc_ns - from_seconds(condition.began_ago_s);
    alarm.cleared_ns = 0;
    return record(AlarmEvent::raised, alarm);
  }
  if (condition.severity > alarm.severity) {
    alarm.severity = condition.severity;
    alarm.acknowledged = false;
    return record(AlarmEvent::worsened, alarm);
  }
  return std::nullopt;  // a new text or value is nothing that an operator has to be told at once
}

std::optional<AlarmEvent> AlarmBook::release(const Name& key, const Instant& now, bool certain) {
  const auto found = entries_.find(key);
  if (found == entries_.end() || !found->second.alarm.active) return std::nullopt;
  Entry& entry = found->second;
  if (entry.unknown_until_ns != 0 && !certain && now.monotonic_ns < entry.unknown_until_ns)
    return std::nullopt;
  if (!entry.away) {
    entry.away = true;
    entry.away_since_ns = now.monotonic_ns;
  }
  if (now.monotonic_ns - entry.away_since_ns < from_seconds(entry.clear_hold_s)) return std::nullopt;
  clear(found, now);
  return AlarmEvent::cleared;
}

std::optional<AlarmEvent> AlarmBook::set(bool active, const Condition& condition, const Instant& now) {
  return active ? hold(condition, now) : release(condition.key, now);
}

void AlarmBook::event(const Condition& condition, const Instant& now) {
  hold(condition, now);
  const auto found = entries_.find(condition.key);
  if (found != entries_.end() && found->second.alarm.active) clear(found, now);
}

void AlarmBook::restore(const Alarm& alarm, const Instant& now, double unknown_s) {
  if (entries_.contains(alarm.alarm) || !make_room(alarm.severity)) return;
  Entry& entry = entries_[alarm.alarm];
  entry.alarm = alarm;
  entry.alarm.header.vehicle = vehicle_;
  if (alarm.active) {
    entry.unknown_until_ns = now.monotonic_ns + from_seconds(unknown_s);
  } else if (entry.alarm.cleared_ns == 0) {
    entry.alarm.cleared_ns = now.utc_ns;
  }
  record(AlarmEvent::restored, entry.alarm);
}

void AlarmBook::settle(const Instant& now) {
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    const auto next = std::next(entry);
    const TimeNs until_ns = entry->second.unknown_until_ns;
    if (entry->second.alarm.active && until_ns != 0 && now.monotonic_ns >= until_ns) clear(entry, now);
    entry = next;
  }
}

int AlarmBook::acknowledge(std::string_view target) {
  int acknowledged = 0;
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    const auto next = std::next(entry);
    Alarm& alarm = entry->second.alarm;
    if (!alarm.acknowledged && (target == "*" || alarm.alarm.view() == target)) {
      alarm.acknowledged = true;
      ++acknowledged;
      record(AlarmEvent::acknowledged, alarm);
      erase_if_done(entry);
    }
    entry = next;
  }
  return acknowledged;
}

std::vector<AlarmTransition> AlarmBook::take_transitions() {
  return std::exchange(transitions_, {});
}

std::vector<Alarm> AlarmBook::all() const {
  std::vector<Alarm> alarms;
  alarms.reserve(entries_.size());
  for (const auto& [key, entry] : entries_) alarms.push_back(entry.alarm);
  std::stable_sort(alarms.begin(), alarms.end(), [](const Alarm& a, const Alarm& b) {
    return std::tuple(!a.active, b.severity, a.since_ns) < std::tuple(!b.active, a.severity, b.since_ns);
  });
  return alarms;
}

const Alarm* AlarmBook::find(const Name& key) const {
  const auto found = entries_.find(key);
  return found == entries_.end() ? nullptr : &found->second.alarm;
}

std::uint32_t AlarmBook::active_count() const {
  return static_cast<std::uint32_t>(std::count_if(entries_.begin(), entries_.end(),
                                                  [](const auto& item) { return item.second.alarm.active; }));
}

std::uint32_t AlarmBook::unacknowledged_count() const {
  return static_cast<std::uint32_t>(std::count_if(
      entries_.begin(), entries_.end(), [](const auto& item) { return !item.second.alarm.acknowledged; }));
}

bool AlarmBook::any_active(Severity at_least) const {
  return std::any_of(entries_.begin(), entries_.end(), [at_least](const auto& item) {
    return item.second.alarm.active && item.second.alarm.severity >= at_least;
  });
}

bool AlarmBook::make_room(Severity severity) {
  if (entries_.size() < kMaxAlarms) return true;
  // The cheapest to lose: cleared before active, then the least severe, then the oldest.
  const auto worth = [](const auto& item) {
    const Alarm& alarm = item.second.alarm;
    return std::tuple(alarm.active, alarm.severity, alarm.since_ns);
  };
  const auto least = std::min_element(entries_.begin(), entries_.end(),
                                      [&](const auto& a, const auto& b) { return worth(a) < worth(b); });
  if (least->second.alarm.active && least->second.alarm.severity >= severity) return false;
  ++dropped_;
  entries_.erase(least);
  return true;
}

void AlarmBook::clear(Entries::iterator found, const Instant& now) {
  Entry& entry = found->second;
  entry.away = false;
  entry.unknown_until_ns = 0;
  entry.alarm.active = false;
  entry.alarm.cleared_ns = now.utc_ns;
  record(AlarmEvent::cleared, entry.alarm);
  erase_if_done(found);
}

AlarmEvent AlarmBook::record(AlarmEvent event, const Alarm& alarm) {
  transitions_.push_back({event, alarm});
  return event;
}

void AlarmBook::erase_if_done(Entries::iterator entry) {
  const Alarm& alarm = entry->second.alarm;
  if (!alarm.active && alarm.acknowledged) entries_.erase(entry);
}

}  // namespace fathom::health
