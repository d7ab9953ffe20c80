#include "fusion/intake_publisher.hpp"

namespace fathom::fusion {

void IntakePublisher::publish(bool all) {
  std::unique_lock one(publishing_, std::defer_lock);
  if (all)
    one.lock();
  else if (!one.try_lock())
    return;  // another thread is at it; the next arrival looks again
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      if (!list_.take(batch_, all, now_ns())) return;
    }
    batch_.header = host_.header();
    batch_.header.sequence = ++sequence_;
    writer_.write(batch_);
  }
}

}  // namespace fathom::fusion
