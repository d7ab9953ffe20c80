#pragma once

#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "base/bytes/little_endian.hpp"

namespace fathom {

namespace detail {
template <std::size_t kBytes>
using UnsignedOf =
    std::conditional_t<kBytes == 8, std::uint64_t,
                       std::conditional_t<kBytes == 4, std::uint32_t,
                                          std::conditional_t<kBytes == 2, std::uint16_t, std::uint8_t>>>;
}  // namespace detail

/// Big-endian value at `offset`. Precondition: it lies inside `bytes`.
template <Scalar T>
[[nodiscard]] T load_be(std::span<const std::uint8_t> bytes, std::size_t offset) {
  assert(offset + sizeof(T) <= bytes.size());
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = value << 8 | bytes[offset + i];
  return std::bit_cast<T>(static_cast<detail::UnsignedOf<sizeof(T)>>(value));
}

/// Appends the big-endian bytes of `value`.
template <Scalar T>
void append_be(std::vector<std::uint8_t>& bytes, std::type_identity_t<T> value) {
  const std::uint64_t bits = std::bit_cast<detail::UnsignedOf<sizeof(T)>>(value);
  for (std::size_t i = sizeof(T); i-- > 0;) bytes.push_back(static_cast<std::uint8_t>(bits >> 8 * i));
}

}  // namespace fathom
