#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "samples/header.hpp"
#include "samples/status/intake.hpp"

namespace fathom::cli {

/// From where to where a recording has the samples of each instrument, by the process of the bridge and by
/// file. A recorder may find a bridge later than fusion does, lose the last words of one that is killed, or
/// be killed itself between two files.
class Spans {
 public:
  struct Origin {
    std::string process;
    std::size_t file = 0;  ///< number of those of the recording
    Name writer;           ///< empty where it is not told
  };
  /// A sample that is in the recording.
  void note(SourceKind source, const SampleHeader& header, const Origin& origin);
  /// Whether what fusion took lies within one of them, so that it ought to be there.
  [[nodiscard]] bool hold(const IntakeEntry& entry) const;

 private:
  struct Span {
    Name writer;
    TimeNs first_ns = 0;
    TimeNs last_ns = 0;
    std::uint64_t first = 0;  ///< sequence
    std::uint64_t last = 0;
  };
  using Spoken = std::map<std::pair<std::string, std::size_t>, Span>;  // by process and file
  std::map<std::pair<SourceKind, Name>, Spoken> spans_;
};

}  // namespace fathom::cli
