#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fathom::codec {

/// CRC-32 of polynomial 0x04C11DB7, initially all ones, not reflected, nothing added at its end: over the
/// bytes and `zeros` more of value 0.
[[nodiscard]] constexpr std::uint32_t crc32_mpeg2(std::span<const std::uint8_t> bytes,
                                                  std::size_t zeros = 0) {
  constexpr std::uint32_t kPolynomial = 0x04C1'1DB7U;
  std::uint32_t crc = 0xFFFF'FFFFU;
  for (std::size_t i = 0; i < bytes.size() + zeros; ++i) {
    if (i < bytes.size()) crc ^= static_cast<std::uint32_t>(bytes[i]) << 24U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000'0000U) != 0 ? crc << 1U ^ kPolynomial : crc << 1U;
  }
  return crc;
}

}  // namespace fathom::codec
