#pragma once

#include <cstdint>
#include <numeric>
#include <span>

namespace fathom::codec {

/// Sum of all bytes, as PD0 and the Ping protocol close their frames.
[[nodiscard]] inline std::uint16_t byte_sum(std::span<const std::uint8_t> bytes) {
  return std::accumulate(bytes.begin(), bytes.end(), std::uint16_t{0});
}

}  // namespace fathom::codec
