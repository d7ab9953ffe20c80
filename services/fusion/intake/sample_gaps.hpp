#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "base/name.hpp"
#include "samples/header.hpp"
#include "samples/kinds.hpp"

namespace fathom::fusion {

/// Counts the samples that never came, by the sequence numbers of those that did.
class SampleGaps {
 public:
  /// A source and its sensor.
  using Stream = std::pair<SourceKind, Name>;
  using Table = std::map<Stream, std::uint64_t>;

  /// Returns how many samples are missing between the last one of that stream and this one. When the number
  /// is lower than the last one, the stream has begun again and nothing is missing.
  [[nodiscard]] std::uint64_t add(SourceKind source, const SampleHeader& header);
  /// The last number of each stream.
  [[nodiscard]] const Table& last() const { return last_; }
  /// Streams from which nothing has arrived yet go on from there.
  void go_on_from(const Table& table);

 private:
  static constexpr std::size_t kMost = 64;  // streams; further ones are not watched
  Table last_;
};

}  // namespace fathom::fusion
