#pragma once

#include <mutex>
#include <vector>

#include "bus/detail/network/peer_book.hpp"
#include "bus/detail/versions/names.hpp"

namespace fathom::bus::detail {

/// Where the participants that look on (ParticipantOptions::low_priority) receive samples. Thread-safe.
class LowPriorityPeers {
 public:
  using Locator = rtps::Locator_t;

  /// Replaces what was known of this participant.
  void seen(const GuidPrefix& prefix, const std::vector<Locator>& at);
  void gone(const GuidPrefix& prefix);

  /// Moves the destinations that are a low-priority peer's behind the others; of either kind the order stays.
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
