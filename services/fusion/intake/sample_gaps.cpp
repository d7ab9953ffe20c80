#include "fusion/intake/sample_gaps.hpp"

namespace fathom::fusion {

std::uint64_t SampleGaps::add(SourceKind source, const SampleHeader& header) {
  const Stream stream{source, header.sensor};
  const auto found = last_.find(stream);
  if (found == last_.end()) {
    if (last_.size() < kMost) last_.emplace(stream, header.sequence);
    return 0;
  }
  const std::uint64_t last = std::exchange(found->second, header.sequence);
  return header.sequence > last + 1 ? header.sequence - last - 1 : 0;
}

void SampleGaps::go_on_from(const Table& table) {
  for (const auto& [stream, sequence] : table) {
    if (last_.size() < kMost) last_.try_emplace(stream, sequence);
  }
}

}  // namespace fathom::fusion
