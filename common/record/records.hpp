#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/time.hpp"
#include "record/bytes.hpp"

/// The records of an MCAP file (https://mcap.dev/spec, version 0). Each struct has the fields of its record
/// in their order; fields.hpp walks them in both directions. What may be large is a view of bytes that belong
/// to somebody else. Times are nanoseconds.
namespace fathom::record {

enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

/// The record's name in words, e.g. "chunk index"; "record 0x42" for one that the specification does not
/// know.
[[nodiscard]] std::string to_string(Op op);

inline constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::size_t kRecordHead = 9;  ///< opcode and length
inline constexpr std::size_t kFooterSize = kRecordHead + 20;

using TextMap = std::map<std::string, std::string>;

struct Header {
  static constexpr Op kOp = Op::header;
  std::string profile;
  std::string library;
};

struct Footer {
  static constexpr Op kOp = Op::footer;
  std::uint64_t summary_start = 0;         ///< 0: no summary
  std::uint64_t summary_offset_start = 0;  ///< 0: no summary offsets
  std::uint32_t summary_crc = 0;           ///< 0: not known
};

struct Schema {
  static constexpr Op kOp = Op::schema;
  std::uint16_t id = 0;  ///< never 0 in a file
  std::string name;
  std::string encoding;
  std::string data;
  bool operator==(const Schema&) const = default;
};

/// In the metadata of a channel: which channels it shares chunks with; without it, "0".
inline constexpr const char* kChunkGroup = "chunk_group";

struct Channel {
  static constexpr Op kOp = Op::channel;
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  ///< 0: no schema
  std::string topic;
  std::string message_encoding;
  TextMap metadata;
  bool operator==(const Channel&) const = default;
};

struct Message {
  static constexpr Op kOp = Op::message;
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  TimeNs log_time = 0;
  TimeNs publish_time = 0;
  View data;
};

struct Chunk {
  static constexpr Op kOp = Op::chunk;
  TimeNs message_start_time = 0;
  TimeNs message_end_time = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  ///< 0: not known
  std::string compression;
  View records;
};

struct MessageIndex {
  static constexpr Op kOp = Op::message_index;
  std::uint16_t channel_id = 0;
  std::vector<std::pair<TimeNs, std::uint64_t>> records;  ///< log time, offset in the uncompressed chunk
};

struct ChunkIndex {
  static constexpr Op kOp = Op::chunk_index;
  TimeNs message_start_time = 0;
  TimeNs message_end_time = 0;
  std::uint64_t chunk_start_offset = 0;
  std::uint64_t chunk_length = 0;
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

struct Attachment {
  static constexpr Op kOp = Op::attachment;
  TimeNs log_time = 0;
  TimeNs create_time = 0;
  std::string name;
  std::string media_type;
  View data;
  std::uint32_t crc = 0;  ///< of the fields before it; 0: not known
};

struct AttachmentIndex {
  static constexpr Op kOp = Op::attachment_index;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  TimeNs log_time = 0;
  TimeNs create_time = 0;
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
};

struct Statistics {
  static constexpr Op kOp = Op::statistics;
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  TimeNs message_start_time = 0;
  TimeNs message_end_time = 0;
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;
};

struct Metadata {
  static constexpr Op kOp = Op::metadata;
  std::string name;
  TextMap metadata;
};

struct MetadataIndex {
  static constexpr Op kOp = Op::metadata_index;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string name;
};

struct SummaryOffset {
  static constexpr Op kOp = Op::summary_offset;
  std::uint8_t group_opcode = 0;
  std::uint64_t group_start = 0;
  std::uint64_t group_length = 0;
};

struct DataEnd {
  static constexpr Op kOp = Op::data_end;
  std::uint32_t data_section_crc = 0;  ///< 0: not known
};

}  // namespace fathom::record
