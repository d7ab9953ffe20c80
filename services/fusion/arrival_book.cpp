#include "fusion/arrival_book.hpp"

#include <algorithm>

namespace fathom::fusion {

void ArrivalBook::note(SourceKind source, const SampleHeader& header, const bus::WriterGuid& writer) {
  entries_[noted_ % kEntries] = {source, header.sensor, header.sequence, writer};
  ++noted_;
}

std::optional<bus::WriterGuid> ArrivalBook::writer_of(const Verdict& verdict) const {
  const std::size_t kept = std::min(noted_, kEntries);
  for (std::size_t back = 1; back <= kept; ++back) {
    const Entry& entry = entries_[(noted_ - back) % kEntries];
    if (entry.source == verdict.source && entry.sequence == verdict.header.sequence &&
        entry.sensor == verdict.header.sensor) {
      return entry.writer;
    }
  }
  return std::nullopt;
}

}  // namespace fathom::fusion
