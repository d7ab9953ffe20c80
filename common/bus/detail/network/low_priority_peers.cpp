#include "bus/detail/network/low_priority_peers.hpp"

#include <algorithm>

namespace fathom::bus::detail {

void LowPriorityPeers::seen(const GuidPrefix& prefix, const std::vector<Locator>& at) {
  const std::lock_guard lock(mutex_);
  std::erase_if(all_, [&](const One& one) { return one.prefix == prefix; });
  for (const Locator& one : at) all_.push_back({prefix, one});
}

void LowPriorityPeers::gone(const GuidPrefix& prefix) {
  seen(prefix, {});
}

void LowPriorityPeers::to_the_back(std::vector<Locator>& destinations) const {
  const std::lock_guard lock(mutex_);
  const auto is_low_priority = [&](const Locator& destination) {
    return std::any_of(all_.begin(), all_.end(), [&](const One& one) { return one.at == destination; });
  };
  // Not std::stable_partition: it allocates.
  auto front = destinations.begin();
  for (auto one = front; one != destinations.end(); ++one) {
    if (is_low_priority(*one)) continue;
    std::rotate(front, one, one + 1);
    ++front;
  }
}

}  // namespace fathom::bus::detail
