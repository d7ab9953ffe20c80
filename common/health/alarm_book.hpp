#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "health/instant.hpp"
#include "samples/status/health.hpp"

namespace fathom::health {

/// A condition that is worth an alarm, as a watcher states it at every evaluation.
struct Condition {
  Name key;
  Severity severity = Severity::warning;
  std::string text;  ///< one English sentence with its numbers
  double value = kUnknown;
  double limit = kUnknown;
  double began_ago_s = 0.0;   ///< how long before now the condition began
  double clear_hold_s = 0.5;  ///< the condition must stay away this long before the alarm clears
};

/// What can happen to an alarm.
enum class AlarmEvent : std::uint8_t {
  restored,  ///< It was in the book of a monitor that ran before this one.
  raised,
  worsened,  ///< Its severity rose.
  cleared,
  acknowledged,
};
[[nodiscard]] std::string_view to_string(AlarmEvent event);

/// One transition of an alarm, with the alarm as it was right after it.
struct AlarmTransition {
  AlarmEvent event = AlarmEvent::raised;
  Alarm alarm;
};

/// The latched alarms of one vehicle, and their transitions.
///
/// An alarm leaves the book only when it is cleared and acknowledged, in either order. When it is raised
/// again while it is still in the book, it is active and unacknowledged again, with a new `since`.
///
/// Each transition is recorded once, when it happens. take_transitions() hands the record out: that list is
/// what is published, written to the journal and logged. An alarm whose text or value alone is new makes no
/// transition.
///
/// At most kMaxAlarms are kept. A new alarm then pushes out the oldest cleared one, or else the oldest active
/// one of lower severity. When there is neither, the new alarm is refused. dropped() counts both.
class AlarmBook {
 public:
  static constexpr std::size_t kMaxAlarms = 64;

  explicit AlarmBook(Name vehicle = {}) : vehicle_(vehicle) {}

  /// The condition holds now. The alarm is raised, or it is kept with the new text and value. While an alarm
  /// is active its severity only rises. A rise withdraws the acknowledgement.
  /// Returns what happened to the alarm: raised, worsened or nothing.
  std::optional<AlarmEvent> hold(const Condition& condition, const Instant& now);
  /// The condition does not hold now. The alarm clears after this was so for `clear_hold_s`, so that a
  /// condition that flickers faster makes one alarm and not many. An alarm that restore() kept active does
  /// not clear before its time, unless the caller is `certain` that the condition does not hold. Returns what
  /// happened to the alarm: cleared or nothing.
  std::optional<AlarmEvent> release(const Name& key, const Instant& now, bool certain = false);
  /// Calls hold() or release(), by `active`.
  std::optional<AlarmEvent> set(bool active, const Condition& condition, const Instant& now);
  /// A momentary event. The alarm is raised and cleared at once, and stays until it is acknowledged.
  void event(const Condition& condition, const Instant& now);

  /// Takes over an alarm from before a restart. An alarm that was active stays active until its condition is
  /// known not to hold, at most for `unknown_s`. One that was cleared stays until it is acknowledged. An
  /// alarm that the book has already is ignored.
  void restore(const Alarm& alarm, const Instant& now, double unknown_s);
  /// Clears what restore() kept active and what nothing has confirmed in time.
  void settle(const Instant& now);

  /// Acknowledges the alarm `target`, or every alarm when it is "*". Returns how many were acknowledged now.
  int acknowledge(std::string_view target);

  /// The transitions since the last call, the oldest first.
  [[nodiscard]] std::vector<AlarmTransition> take_transitions();
  /// Every alarm: active ones first, then by severity, then by age.
  [[nodiscard]] std::vector<Alarm> all() const;
  [[nodiscard]] const Alarm* find(const Name& key) const;
  [[nodiscard]] std::uint32_t active_count() const;
  [[nodiscard]] std::uint32_t unacknowledged_count() const;
  /// Whether an active alarm is at least this severe.
  [[nodiscard]] bool any_active(Severity at_least) const;
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  [[nodiscard]] const Name& vehicle() const { return vehicle_; }

 private:
  struct Entry {
    Alarm alarm;
    TimeNs away_since_ns =
        0;  ///< Monotonic; when the condition was first released while the alarm is active.
    bool away = false;
    TimeNs unknown_until_ns = 0;  ///< Monotonic; how long a restored alarm stays unconfirmed, 0: confirmed.
    double clear_hold_s = 0.5;
  };
  using Entries = std::map<Name, Entry>;

  bool make_room(Severity severity);
  void clear(Entries::iterator found, const Instant& now);
  AlarmEvent record(AlarmEvent event, const Alarm& alarm);
  void erase_if_done(Entries::iterator entry);

  Name vehicle_;
  Entries entries_;
  std::vector<AlarmTransition> transitions_;
  std::uint64_t dropped_ = 0;
};

}  // namespace fathom::health
