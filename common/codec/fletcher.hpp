#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace fathom::codec {

/// Fletcher's checksum modulo 256, in the order in which it is sent: the sum of all bytes, and the sum of
/// those sums.
[[nodiscard]] constexpr std::array<std::uint8_t, 2> fletcher8(std::span<const std::uint8_t> bytes) {
  std::uint8_t sum = 0;
  std::uint8_t sum_of_sums = 0;
  for (const std::uint8_t byte : bytes) {
    sum = static_cast<std::uint8_t>(sum + byte);
    sum_of_sums = static_cast<std::uint8_t>(sum_of_sums + sum);
  }
  return {sum, sum_of_sums};
}

}  // namespace fathom::codec
