#pragma once

#include <bit>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace fathom {

template <class T>
concept Scalar = std::integral<T> || std::floating_point<T>;

/// Little-endian value at `offset`. Precondition: it lies inside `bytes`.
template <Scalar T>
[[nodiscard]] T load_le(std::span<const std::uint8_t> bytes, std::size_t offset) {
  static_assert(std::endian::native == std::endian::little, "little-endian values are copied");
  assert(offset + sizeof(T) <= bytes.size());
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

/// Appends the little-endian bytes of `value`.
template <Scalar T>
void append_le(std::vector<std::uint8_t>& bytes, std::type_identity_t<T> value) {
  static_assert(std::endian::native == std::endian::little, "little-endian values are copied");
  const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof(T));
}

/// Writes them over those at `offset`. Precondition: they lie inside `bytes`.
template <Scalar T>
void store_le(std::span<std::uint8_t> bytes, std::size_t offset, std::type_identity_t<T> value) {
  static_assert(std::endian::native == std::endian::little, "little-endian values are copied");
  assert(offset + sizeof(T) <= bytes.size());
  std::memcpy(bytes.data() + offset, &value, sizeof(T));
}

}  // namespace fathom
