#include "record/walk.hpp"

#include <algorithm>
#include <array>

#include "record/compression.hpp"

namespace fathom::record {
namespace {

std::uint64_t length_in(std::span<const std::uint8_t> head) {
  std::uint64_t length = 0;
  for (std::size_t i = 0; i < sizeof length; ++i)
    length |= static_cast<std::uint64_t>(head[1 + i]) << (8 * i);
  return length;
}

std::string at_offset(std::uint64_t offset, const std::string& what) {
  return "offset " + std::to_string(offset) + ": " + what;
}

/// Why a record of this head cannot be read; empty when it can.
std::string objection(Op op, std::uint64_t offset, std::uint64_t length, std::uint64_t left) {
  if (op == Op{}) return at_offset(offset, "opcode 0, expected a record");
  if (length <= left) return {};
  return at_offset(offset, to_string(op) + ": " + std::to_string(length) + " bytes long, but only " +
                               std::to_string(left) + " are there");
}

}  // namespace

bool Walk::next(Place& place) {
  if (!fault_.empty() || at_ == end_) return false;
  std::array<std::uint8_t, kRecordHead> head{};
  const std::uint64_t left = end_ - at_;
  if (left < head.size()) {
    fault_ = at_offset(at_, "a record's head of 9 bytes, but only " + std::to_string(left) + " are there");
    return false;
  }
  if (const std::string why = source_.read(at_, head); !why.empty()) {
    fault_ = at_offset(at_, why);
    return false;
  }
  const Op op{head[0]};
  const std::uint64_t length = length_in(head);
  fault_ = objection(op, at_, length, left - head.size());
  if (fault_.empty() && length > limits_.record_bytes) {
    fault_ = at_offset(at_, to_string(op) + ": " + std::to_string(length) + " bytes long, expected at most " +
                                std::to_string(limits_.record_bytes));
  }
  if (!fault_.empty()) return false;
  buffer_.resize(static_cast<std::size_t>(length));
  if (const std::string why = source_.read(at_ + head.size(), buffer_); !why.empty()) {
    fault_ = at_offset(at_, why);
    return false;
  }
  place = {op, at_, buffer_};
  at_ = place.end();
  return true;
}

bool MemoryWalk::next(Place& place) {
  if (!fault_.empty() || at_ == bytes_.size()) return false;
  const View left = bytes_.subspan(static_cast<std::size_t>(at_));
  if (left.size() < kRecordHead) {
    fault_ =
        at_offset(at_, "a record's head of 9 bytes, but only " + std::to_string(left.size()) + " are there");
    return false;
  }
  const Op op{left[0]};
  const std::uint64_t length = length_in(left);
  fault_ = objection(op, at_, length, left.size() - kRecordHead);
  if (!fault_.empty()) return false;
  place = {op, at_, left.subspan(kRecordHead, static_cast<std::size_t>(length))};
  at_ = place.end();
  return true;
}

Result<Bytes> open_chunk(const Chunk& chunk, const Limits& limits) {
  if (chunk.uncompressed_size > limits.chunk_bytes) {
    return Error{"chunk: " + std::to_string(chunk.uncompressed_size) + " bytes unpacked, expected at most " +
                 std::to_string(limits.chunk_bytes)};
  }
  auto bytes = unpack(chunk.compression, chunk.records, static_cast<std::size_t>(chunk.uncompressed_size));
  if (!bytes) return Error{"chunk: " + bytes.error().message};
  if (chunk.uncompressed_crc != 0 && crc32(bytes.value()) != chunk.uncompressed_crc) {
    return Error{"chunk: its bytes do not fit its CRC"};
  }
  return bytes;
}

Result<std::uint32_t> crc_of(Source& source, std::uint64_t size) {
  constexpr std::uint64_t kBlock = 1U << 20U;
  Bytes block;
  std::uint32_t crc = 0;
  for (std::uint64_t at = 0; at < size; at += block.size()) {
    block.resize(static_cast<std::size_t>(std::min(kBlock, size - at)));
    if (const std::string why = source.read(at, block); !why.empty()) return Error{at_offset(at, why)};
    crc = crc32(block, crc);
  }
  return crc;
}

}  // namespace fathom::record
