#include "blackbox/queue.hpp"

#include <chrono>
#include <utility>

namespace fathom::blackbox {
namespace {

constexpr std::uint64_t kOverhead = 128;  // of an item, beside its bytes
// Events and enclosures are few, and much is lost with one: this part of the room more is theirs alone.
constexpr std::uint64_t kReserve = 4;

}  // namespace

std::uint32_t Queue::add(Origin origin) {
  const std::lock_guard lock(mutex_);
  topics_.push_back(origin.topic);
  items_.emplace_back(std::move(origin));  // few, and nothing can be kept without them
  return static_cast<std::uint32_t>(topics_.size() - 1);
}

void Queue::put(Sample sample) {
  const std::uint64_t bytes = sample.bytes.size() + sample.key.size();
  const TimeNs time_ns = sample.log_ns;
  put(Item(std::move(sample)), bytes, time_ns);
}

void Queue::put(Event event) {
  const std::uint64_t bytes = event.kind.size() + event.text.size();
  const TimeNs time_ns = event.time_ns;
  put(Item(std::move(event)), bytes, time_ns);
}

void Queue::put(Enclosure enclosure) {
  const std::uint64_t bytes = enclosure.data.size() + enclosure.name.size();
  const TimeNs time_ns = enclosure.created_ns;
  put(Item(std::move(enclosure)), bytes, time_ns);
}

void Queue::put(Item item, std::uint64_t bytes, TimeNs time_ns) {
  bytes += kOverhead;
  bool half = false;
  {
    const std::lock_guard lock(mutex_);
    const auto* sample = std::get_if<Sample>(&item);
    const std::uint64_t room = sample != nullptr ? most_bytes_ : most_bytes_ + most_bytes_ / kReserve;
    if (bytes_ + bytes > room) {
      const bool is_event = std::holds_alternative<Event>(item);
      Dropped& dropped = dropped_[sample != nullptr ? topics_.at(sample->origin)
                                  : is_event        ? "events"
                                                    : "enclosures"];
      if (dropped.count++ == 0) dropped.first_ns = time_ns;
      dropped.last_ns = time_ns;
      ++dropped_total_;
      return;
    }
    half = bytes_ <= most_bytes_ / 2 && bytes_ + bytes > most_bytes_ / 2;
    bytes_ += bytes;
    items_.push_back(std::move(item));
  }
  if (half) wake_.notify_one();
}

Queue::Batch Queue::take(DurationNs patience_ns) {
  std::unique_lock lock(mutex_);
  wake_.wait_for(lock, std::chrono::nanoseconds(patience_ns),
                 [this] { return ended_ || bytes_ > most_bytes_ / 2; });
  bytes_ = 0;
  return {std::exchange(items_, {}), std::exchange(dropped_, {}), ended_};
}

void Queue::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  wake_.notify_one();
}

std::uint64_t Queue::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_total_;
}

}  // namespace fathom::blackbox
