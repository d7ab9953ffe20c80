#include "fusion/intake_publisher.hpp"

#include <algorithm>
#include <utility>

namespace fathom::fusion {
namespace {

constexpr DurationNs kPatience_ns = 100 * kNsPerMillisecond;

}  // namespace

void IntakePublisher::add(IntakeEntry entry) {
  if (waiting_.empty()) oldest_ns_ = host_.clock().monotonic_ns();
  waiting_.push_back(entry);
}

void IntakePublisher::add(const Arrival& arrival) {
  const SampleHeader& header = arrival.header();
  add(IntakeEntry{false, arrival.source(), header.sensor, arrival.writer, header.stamp_ns, header.sequence});
}

void IntakePublisher::add(const Command& order) {
  const SampleHeader& header = order.header;
  add(IntakeEntry{true, SourceKind::imu, header.sensor, {}, header.stamp_ns, header.sequence});
}

void IntakePublisher::publish(bool all) {
  for (;;) {
    IntakeRecord batch;
    {
      const std::lock_guard lock(mutex_);
      const bool due = waiting_.size() >= IntakeRecord::kMostEntries / 2 ||
                       host_.clock().monotonic_ns() - oldest_ns_ >= kPatience_ns || all;
      if (waiting_.empty() || !due) return;
      const auto end = waiting_.begin() +
                       static_cast<std::ptrdiff_t>(std::min(waiting_.size(), IntakeRecord::kMostEntries));
      batch.entries.assign(waiting_.begin(), end);
      waiting_.erase(waiting_.begin(), end);
      batch.header = host_.header();
      batch.header.sequence = ++sequence_;
      batch.first = published_;
      batch.resumed = resumed_;
      published_ += batch.entries.size();
    }
    writer_.write(batch);
  }
}

}  // namespace fathom::fusion
