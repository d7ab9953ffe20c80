#include "bus/detail/network/acknowledgements.hpp"

#include <span>

namespace fathom::bus::detail {

void AcknowledgementBook::seen(const GuidPrefix& participant) {
  const std::lock_guard lock(mutex_);
  last_.try_emplace(participant);
}

void AcknowledgementBook::gone(const GuidPrefix& participant) {
  const std::lock_guard lock(mutex_);
  last_.erase(participant);
}

bool AcknowledgementBook::goes_back(const Acknowledgement& one) {
  const std::lock_guard lock(mutex_);
  const auto known = last_.find(prefix_of(one.reader));
  if (known == last_.end()) return false;
  auto& pairs = known->second;
  if (pairs.size() >= kMostPairs) pairs.clear();
  Last& last = pairs[{to_entity_id(std::span(one.reader).subspan(12)), one.writer}];
  if (one.count <= last.count) return false;  // late, and Fast DDS does not obey it
  const bool back = one.base != 0 && one.base < last.base;
  last = {one.base, one.count};
  return back;
}

}  // namespace fathom::bus::detail
