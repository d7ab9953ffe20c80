#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mavlink/definition.hpp"

namespace fathom::mavlink {

using Bytes = std::span<const std::uint8_t>;

inline constexpr std::uint8_t kMagicV1 = 0xFE;
inline constexpr std::uint8_t kMagicV2 = 0xFD;
inline constexpr std::size_t kHeaderV1 = 6;
inline constexpr std::size_t kHeaderV2 = 10;
inline constexpr std::size_t kChecksum = 2;
inline constexpr std::size_t kSignature = 13;  ///< link, time, 48 bits of SHA-256
inline constexpr std::uint8_t kFlagSigned = 0x01;
inline constexpr std::size_t kMostFrame = kHeaderV2 + kMostPayload + kChecksum + kSignature;

/// A whole frame whose checksum is right. The spans are of the bytes that it was found in.
struct Frame {
  Bytes whole;
  Bytes payload;
  std::uint32_t id = 0;
  std::uint8_t sequence = 0;
  std::uint8_t system = 0;
  std::uint8_t component = 0;
  bool is_signed = false;
};

/// What stands at the front of a stream.
struct Look {
  enum class Kind : std::uint8_t {
    skip,      ///< `length` bytes begin no frame
    need,      ///< `length` bytes, at least, are wanted to tell
    frame,     ///< a good one of `length` bytes
    checksum,  ///< one of `length` bytes whose checksum is wrong
    length,    ///< one that declares a payload that its message cannot have; `length` bytes of header
  };
  Kind kind = Kind::skip;
  std::size_t length = 0;
  Frame frame{};
};

/// `front` is not empty. A frame of a message that no published dialect has is skipped by one byte: without
/// the seed of its checksum nobody can tell it from noise.
[[nodiscard]] Look look_at(Bytes front);

/// Who speaks.
struct Sender {
  std::uint8_t system = 1;
  std::uint8_t component = 197;  ///< MAV_COMP_ID_VISUAL_INERTIAL_ODOMETRY
};

/// A frame of MAVLink 2 up to its checksum, zeros at the end of the payload left out. `flags`: kFlagSigned
/// when a signature will follow.
[[nodiscard]] std::vector<std::uint8_t> frame_of(std::uint32_t id, std::uint8_t crc_extra, Bytes payload,
                                                 const Sender& sender, std::uint8_t sequence,
                                                 std::uint8_t flags = 0);

template <class M>
[[nodiscard]] std::vector<std::uint8_t> frame_of(const M& message, const Sender& sender,
                                                 std::uint8_t sequence, std::uint8_t flags = 0) {
  return frame_of(M::kId, Definition<M>::kCrcExtra, payload_of(message), sender, sequence, flags);
}

}  // namespace fathom::mavlink
