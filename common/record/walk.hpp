#pragma once

#include <cstdint>
#include <string>

#include "base/result.hpp"
#include "record/bytes.hpp"
#include "record/file.hpp"
#include "record/records.hpp"

namespace fathom::record {

/// What reading a recording may take of memory.
struct Limits {
  std::uint64_t record_bytes = 256U << 20U;  ///< of one record
  std::uint64_t chunk_bytes = 256U << 20U;   ///< of one chunk, unpacked
};

/// A record where it stands, not parsed.
struct Place {
  Op op{};
  std::uint64_t offset = 0;  ///< of its opcode
  View content;

  [[nodiscard]] std::uint64_t end() const { return offset + kRecordHead + content.size(); }
};

/// Goes from record to record of a file.
class Walk {
 public:
  Walk(Source& source, std::uint64_t begin, std::uint64_t end, const Limits& limits)
      : source_(source), at_(begin), end_(end), limits_(limits) {}

  /// The next record; its content is valid until the next call. False at the end and at a fault.
  [[nodiscard]] bool next(Place& place);
  /// Why there is no next record; empty at the end of the file.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Behind the last whole record.
  [[nodiscard]] std::uint64_t at() const { return at_; }

 private:
  Source& source_;
  std::uint64_t at_;
  std::uint64_t end_;
  Limits limits_;
  std::string fault_;
  Bytes buffer_;
};

/// Likewise for records in memory, those of an unpacked chunk. Offsets count from the beginning of `bytes`.
class MemoryWalk {
 public:
  explicit MemoryWalk(View bytes) : bytes_(bytes) {}
  [[nodiscard]] bool next(Place& place);
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  View bytes_;
  std::uint64_t at_ = 0;
  std::string fault_;
};

/// The records of a chunk, unpacked and held against its size and CRC.
[[nodiscard]] Result<Bytes> open_chunk(const Chunk& chunk, const Limits& limits);

/// CRC-32 of the first `size` bytes of a source.
[[nodiscard]] Result<std::uint32_t> crc_of(Source& source, std::uint64_t size);

}  // namespace fathom::record
