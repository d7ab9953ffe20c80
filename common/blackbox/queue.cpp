#include "blackbox/queue.hpp"

#include <chrono>
#include <utility>

namespace fathom::blackbox {
namespace {

constexpr std::uint64_t kOverhead = 128;  // of an item, beside its bytes

}  // namespace

std::uint32_t Queue::add(Origin origin) {
  const std::lock_guard lock(mutex_);
  topics_.push_back(origin.topic);
  items_.emplace_back(std::move(origin));  // few, and nothing can be kept without them
  return static_cast<std::uint32_t>(topics_.size() - 1);
}

void Queue::put(Sample sample) {
  const std::uint64_t bytes = sample.bytes.size() + sample.key.size() + kOverhead;
  {
    const std::lock_guard lock(mutex_);
    if (bytes_ + bytes > most_bytes_) {
      Dropped& dropped = dropped_[topics_.at(sample.origin)];
      if (dropped.count++ == 0) dropped.first_ns = sample.log_ns;
      dropped.last_ns = sample.log_ns;
      ++dropped_total_;
      return;
    }
  }
  put(Item(std::move(sample)), bytes);
}

void Queue::put(Event event) {
  put(Item(std::move(event)), kOverhead);
}

void Queue::put(Enclosure enclosure) {
  const std::uint64_t bytes = enclosure.data.size() + kOverhead;
  put(Item(std::move(enclosure)), bytes);
}

void Queue::put(Item item, std::uint64_t bytes) {
  bool half = false;
  {
    const std::lock_guard lock(mutex_);
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
