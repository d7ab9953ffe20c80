#pragma once

#include <cstdint>
#include <span>

namespace fathom::codec {

/// CRC-16 of polynomial 0x1021, initially 0, not reflected.
[[nodiscard]] constexpr std::uint16_t crc16_ccitt(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ byte << 8);
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint16_t>(crc & 0x8000U ? crc << 1 ^ 0x1021 : crc << 1);
    }
  }
  return crc;
}

}  // namespace fathom::codec
