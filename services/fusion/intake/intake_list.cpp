#include "fusion/intake/intake_list.hpp"

#include <algorithm>

namespace fathom::fusion {
namespace {

constexpr DurationNs kPatience_ns = 100 * kNsPerMillisecond;

}  // namespace

void IntakeList::add(const IntakeEntry& entry, TimeNs now_ns) {
  if (waiting_.empty()) oldest_ns_ = now_ns;
  waiting_.push_back(entry);
}

void IntakeList::add(const Arrival& arrival, bool again, TimeNs now_ns) {
  const SampleHeader& header = arrival.header();
  add({IntakeKind::sample, arrival.source(), header.sensor, arrival.writer, header.stamp_ns, header.sequence,
       again},
      now_ns);
}

void IntakeList::add(const Command& order, bool again, TimeNs now_ns) {
  const SampleHeader& header = order.header;
  add({IntakeKind::order, SourceKind::imu, header.sensor, {}, header.stamp_ns, header.sequence, again},
      now_ns);
}

void IntakeList::add_state(TimeNs stamp_ns, std::uint64_t digest, const Name& saved_by, TimeNs now_ns) {
  add({IntakeKind::state, SourceKind::imu, saved_by, {}, stamp_ns, digest, false}, now_ns);
}

void IntakeList::add_end(TimeNs now_ns) {
  add({IntakeKind::end, SourceKind::imu, {}, {}, 0, 0, false}, now_ns);
}

bool IntakeList::take(IntakeRecord& batch, bool all, TimeNs now_ns) {
  const bool due =
      all || waiting_.size() >= IntakeRecord::kMostEntries / 2 || now_ns - oldest_ns_ >= kPatience_ns;
  if (waiting_.empty() || !due) return false;
  const std::size_t count = std::min(waiting_.size(), IntakeRecord::kMostEntries);
  const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(count);
  batch.entries.assign(waiting_.begin(), end);
  waiting_.erase(waiting_.begin(), end);
  batch.first = taken_;
  taken_ += count;
  return true;
}

}  // namespace fathom::fusion
