#pragma once

#include <cstdint>
#include <vector>

#include "base/time.hpp"
#include "fusion/intake/arrival.hpp"
#include "samples/command.hpp"
#include "samples/status/intake.hpp"

namespace fathom::fusion {

/// The list of what the engine was given, in its order, until it is published. Times are monotonic. Nothing
/// is allocated after construction as long as fewer than `kRoom` entries wait, which is always so but when a
/// state of another fusion is taken up. Pure and not thread-safe.
class IntakeList {
 public:
  static constexpr std::size_t kRoom = 4 * IntakeRecord::kMostEntries;

  IntakeList() { waiting_.reserve(kRoom); }

  /// `again`: what the engine says of it is not published (IntakeEntry::again).
  void add(const Arrival& arrival, bool again, TimeNs now_ns);
  void add(const Command& order, bool again, TimeNs now_ns);
  /// A state that the engine went on from: its stamp, its digest, and who saved it.
  void add_state(TimeNs stamp_ns, std::uint64_t digest, const Name& saved_by, TimeNs now_ns);
  void add_end(TimeNs now_ns);

  /// Puts the next entries and their number into `batch`, when they are many enough, old enough or `all` is
  /// wanted; else false.
  [[nodiscard]] bool take(IntakeRecord& batch, bool all, TimeNs now_ns);

 private:
  void add(const IntakeEntry& entry, TimeNs now_ns);

  std::vector<IntakeEntry> waiting_;
  TimeNs oldest_ns_ = 0;
  std::uint64_t taken_ = 0;
};

}  // namespace fathom::fusion
