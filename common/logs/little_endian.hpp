#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace fathom::logs {

static_assert(std::endian::native == std::endian::little, "both log formats and every machine of ours are");

/// Precondition: the bytes are there.
template <class T>
[[nodiscard]] T load(std::span<const std::uint8_t> bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

}  // namespace fathom::logs
