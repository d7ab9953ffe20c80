#include "live/record/spans.hpp"

#include <algorithm>

namespace fathom::cli {

void Spans::note(SourceKind source, const SampleHeader& header, const Origin& origin) {
  const Span fresh{origin.writer, header.stamp_ns, header.stamp_ns, header.sequence, header.sequence};
  const auto [at, is_new] = spans_[{source, header.sensor}].try_emplace({origin.process, origin.file}, fresh);
  if (is_new) return;
  Span& span = at->second;
  span.first_ns = std::min(span.first_ns, header.stamp_ns);
  span.last_ns = std::max(span.last_ns, header.stamp_ns);
  span.first = std::min(span.first, header.sequence);
  span.last = std::max(span.last, header.sequence);
}

bool Spans::hold(const IntakeEntry& entry) const {
  const auto found = spans_.find({entry.source, entry.sensor});
  if (found == spans_.end()) return false;
  return std::any_of(found->second.begin(), found->second.end(), [&](const auto& one) {
    const Span& span = one.second;
    const bool own = span.writer.empty() || entry.writer.empty() || span.writer == entry.writer;
    return own && entry.sequence >= span.first && entry.sequence <= span.last &&
           entry.stamp_ns >= span.first_ns && entry.stamp_ns <= span.last_ns;
  });
}

}  // namespace fathom::cli
