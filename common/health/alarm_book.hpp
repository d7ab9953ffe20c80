#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "health/instant.hpp"
#include "samples/status/health.hpp"

namespace fathom::health {

/// A condition worth an alarm, as a watcher states it at every evaluation.
struct Condition {
  Name key;
  Severity severity = Severity::warning;
  std::string text;  ///< one English sentence with its numbers
  double value = kUnknown;
  double limit = kUnknown;
  double began_ago_s = 0.0;   ///< how long before now the condition began
  double clear_hold_s = 0.5;  ///< the condition must stay away this long before the alarm clears
};

/// Latched alarms.
///
/// An alarm leaves the book only when it is cleared and acknowledged, in either order. Raised again while it
/// is still in the book, it is active and unacknowledged anew, with a new `since`.
///
/// At most kMaxAlarms are kept. A new one then pushes out the oldest cleared alarm, else the oldest active
/// one of lower severity, else it is refused; either way dropped() counts it.
class AlarmBook {
 public:
  static constexpr std::size_t kMaxAlarms = 64;

  explicit AlarmBook(Name vehicle = {}) : vehicle_(vehicle) {}

  /// The condition holds now. Raises the alarm, or keeps it and refreshes text and value. While it is active
  /// its severity only rises; a rise withdraws an acknowledgement, for it is news.
  void hold(const Condition& condition, const Instant& now);
  /// The condition does not hold. The alarm clears once that has been so for `clear_hold_s`: a condition that
  /// flickers faster is one alarm, not many.
  /// `certain` false: as far as is known. An alarm of before a restart then waits for its time.
  void release(const Name& key, const Instant& now, bool certain = false);
  /// hold() or release() by `active`, for conditions whose text is cheap.
  void set(bool active, const Condition& condition, const Instant& now);
  /// A momentary event: raised and cleared in one, it stays until acknowledged.
  void event(const Condition& condition, const Instant& now);

  /// An alarm of before a restart. One that was active stays active until its condition is known again not to
  /// hold, at most for `unknown_s`; one that was over stays until it is acknowledged. Ignored when the book
  /// has it already.
  void restore(const Alarm& alarm, const Instant& now, double unknown_s);
  /// Clears what restore() kept active and nothing has confirmed in time.
  void settle(const Instant& now);

  /// "*" acknowledges every alarm. Returns how many were newly acknowledged.
  int acknowledge(std::string_view target, const Instant& now);

  /// What changed since the last call, oldest change first, each alarm as it is now. A removed alarm appears
  /// once more, cleared and acknowledged.
  [[nodiscard]] std::vector<Alarm> take_changes();
  /// Everything in the book, active first, then by severity, then by age.
  [[nodiscard]] std::vector<Alarm> all() const;
  [[nodiscard]] const Alarm* find(const Name& key) const;
  [[nodiscard]] std::uint32_t active_count() const;
  [[nodiscard]] std::uint32_t unacknowledged_count() const;
  /// True when an active alarm is at least this severe.
  [[nodiscard]] bool any_active(Severity at_least) const;
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  [[nodiscard]] const Name& vehicle() const { return vehicle_; }

 private:
  struct Entry {
    Alarm alarm;
    TimeNs away_since_ns = 0;  ///< monotonic; when the condition was first released, while still active
    bool away = false;
    TimeNs unknown_until_ns = 0;  ///< monotonic; of an alarm of before a restart, 0: known
    double clear_hold_s = 0.5;
  };

  bool make_room(Severity severity);
  void clear(Entry& entry, const Instant& now);
  void note_change(const Alarm& alarm);
  void erase_if_done(std::map<Name, Entry>::iterator entry);

  Name vehicle_;
  std::map<Name, Entry> entries_;
  std::vector<Alarm> changes_;
  std::uint64_t dropped_ = 0;
};

}  // namespace fathom::health
