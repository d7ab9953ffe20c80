#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "record/records.hpp"

namespace fathom::record {

/// The table of contents of a recording: what its summary says, or what going through it found.
struct Contents {
  Header header;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<ChunkIndex> chunks;  ///< in the order of the file
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  Statistics statistics;

  bool indexed = false;               ///< taken from the summary
  bool loose_messages = false;        ///< messages outside of chunks, which no index finds
  std::string ending;                 ///< empty: the file is whole; else how it ends, in words
  std::uint64_t end_of_data = 0;      ///< behind the last whole record of the data section
  std::vector<std::string> problems;  ///< records that could not be used, with their offsets; the first 100
};

inline constexpr std::size_t kMostProblems = 100;

/// Counts a message.
void count(Statistics& statistics, std::uint16_t channel, TimeNs log_time, std::uint64_t before_count);

/// Summary and end of a file whose data section ends at `contents.end_of_data`: data end, summary, summary
/// offsets, footer, magic.
[[nodiscard]] Bytes closing(const Contents& contents, std::uint32_t data_crc);

}  // namespace fathom::record
