#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace fathom::mavlink {

/// CRC-16/MCRF4XX, which MAVLink calls X.25: goes on from `crc`.
[[nodiscard]] constexpr std::uint16_t crc_with(std::uint8_t byte, std::uint16_t crc) {
  auto mixed = static_cast<std::uint8_t>(byte ^ (crc & 0xFFU));
  mixed = static_cast<std::uint8_t>(mixed ^ (mixed << 4U));
  return static_cast<std::uint16_t>((crc >> 8U) ^ (mixed << 8U) ^ (mixed << 3U) ^ (mixed >> 4U));
}

inline constexpr std::uint16_t kCrcBegin = 0xFFFF;

[[nodiscard]] constexpr std::uint16_t crc_of(std::span<const std::uint8_t> bytes,
                                             std::uint16_t crc = kCrcBegin) {
  for (const std::uint8_t byte : bytes) crc = crc_with(byte, crc);
  return crc;
}
[[nodiscard]] constexpr std::uint16_t crc_of(std::string_view text, std::uint16_t crc = kCrcBegin) {
  for (const char c : text) crc = crc_with(static_cast<std::uint8_t>(c), crc);
  return crc;
}

}  // namespace fathom::mavlink
