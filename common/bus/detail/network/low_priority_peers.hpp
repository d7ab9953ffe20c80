#pragma once

#include <mutex>
#include <vector>

#include "bus/detail/network/peer_book.hpp"
#include "bus/detail/versions/names.hpp"

namespace fathom::bus::detail {

/// The addresses at which low-priority participants (ParticipantOptions::low_priority) receive samples.
/// Thread-safe.
class LowPriorityPeers {
 public:
  using Locator = rtps::Locator_t;

  /// Replaces what was known of this participant.
  void seen(const GuidPrefix& prefix, const std::vector<Locator>& at);
  void gone(const GuidPrefix& prefix);

  /// Moves the destinations of low-priority peers behind the others. The order among each stays.
  void to_the_back(std::vector<Locator>& destinations) const;

 private:
  struct One {
    GuidPrefix prefix;
    Locator at;
  };
  mutable std::mutex mutex_;
  std::vector<One> all_;
};

}  // namespace fathom::bus::detail
