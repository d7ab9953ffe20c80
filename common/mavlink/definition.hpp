#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "base/bytes/little_endian.hpp"
#include "mavlink/crc.hpp"

/// Messages of MAVLink as structs. A struct names its fields once, in the order of the dialect; layout on the
/// wire, checksum seed and conversion follow from that by the rules of the protocol.
namespace fathom::mavlink {

inline constexpr std::size_t kMostPayload = 255;

namespace detail {

template <class T>
struct Element {
  using type = T;
  static constexpr std::size_t kCount = 1;
  static constexpr bool kIsArray = false;
};
template <class T, std::size_t N>
struct Element<std::array<T, N>> {
  using type = T;
  static constexpr std::size_t kCount = N;
  static constexpr bool kIsArray = true;
};

template <class T>
[[nodiscard]] consteval std::string_view type_word() {
  if constexpr (std::is_same_v<T, std::uint8_t>) return "uint8_t";
  if constexpr (std::is_same_v<T, std::int8_t>) return "int8_t";
  if constexpr (std::is_same_v<T, std::uint16_t>) return "uint16_t";
  if constexpr (std::is_same_v<T, std::int16_t>) return "int16_t";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "uint32_t";
  if constexpr (std::is_same_v<T, std::int32_t>) return "int32_t";
  if constexpr (std::is_same_v<T, std::uint64_t>) return "uint64_t";
  if constexpr (std::is_same_v<T, std::int64_t>) return "int64_t";
  if constexpr (std::is_same_v<T, float>) return "float";
  if constexpr (std::is_same_v<T, double>) return "double";
}

}  // namespace detail

template <class M, class T>
struct Field {
  using Value = T;
  using Scalar = typename detail::Element<T>::type;
  static constexpr std::size_t kCount = detail::Element<T>::kCount;
  static constexpr std::size_t kBytes = kCount * sizeof(Scalar);

  constexpr Field(std::string_view its_name, T M::*its_member) : name(its_name), member(its_member) {}
  std::string_view name;
  T M::*member;
};

/// M has kId, kName, kFields (a tuple of Field) and kExtensions, how many of the last fields came later than
/// the message.
template <class M>
struct Definition {
  static constexpr std::size_t kFieldCount = std::tuple_size_v<decltype(M::kFields)>;
  static constexpr std::size_t kBaseCount = kFieldCount - M::kExtensions;

  /// The wire order: by the size of a scalar, largest first; extensions as they stand.
  static constexpr std::array<std::size_t, kFieldCount> kOrder = [] {
    std::array<std::size_t, kFieldCount> sizes{};
    std::size_t at = 0;
    std::apply(
        [&](const auto&... field) {
          ((sizes[at++] = sizeof(typename std::decay_t<decltype(field)>::Scalar)), ...);
        },
        M::kFields);
    std::array<std::size_t, kFieldCount> order{};
    for (std::size_t i = 0; i < kFieldCount; ++i) order[i] = i;
    // Insertion keeps equals in their order.
    for (std::size_t i = 1; i < kBaseCount; ++i)
      for (std::size_t j = i; j > 0 && sizes[order[j]] > sizes[order[j - 1]]; --j)
        std::swap(order[j], order[j - 1]);
    return order;
  }();

  /// Calls `visit(field)` in the order of the wire.
  template <class Visit>
  static constexpr void for_each(Visit&& visit) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (visit(std::get<kOrder[I]>(M::kFields)), ...);
    }
    (std::make_index_sequence<kFieldCount>());
  }

  static constexpr std::size_t kSize = [] {
    std::size_t sum = 0;
    for_each([&](const auto& field) { sum += std::decay_t<decltype(field)>::kBytes; });
    return sum;
  }();
  static_assert(kSize <= kMostPayload);

  /// Seeds the checksum, so that who has another definition of the message does not read it.
  static constexpr std::uint8_t kCrcExtra = [] {
    std::uint16_t crc = crc_of(" ", crc_of(M::kName));
    std::size_t at = 0;
    for_each([&](const auto& field) {
      using F = std::decay_t<decltype(field)>;
      if (at++ >= kBaseCount) return;
      crc = crc_of(" ", crc_of(detail::type_word<typename F::Scalar>(), crc));
      crc = crc_of(" ", crc_of(field.name, crc));
      if constexpr (detail::Element<typename F::Value>::kIsArray)
        crc = crc_with(static_cast<std::uint8_t>(F::kCount), crc);
    });
    return static_cast<std::uint8_t>((crc & 0xFFU) ^ (crc >> 8U));
  }();
};

/// The whole payload, zeros at the end included.
template <class M>
[[nodiscard]] std::array<std::uint8_t, Definition<M>::kSize> payload_of(const M& message) {
  std::array<std::uint8_t, Definition<M>::kSize> out{};
  std::size_t at = 0;
  Definition<M>::for_each([&](const auto& field) {
    using F = std::decay_t<decltype(field)>;
    const auto& value = message.*(field.member);
    if constexpr (detail::Element<typename F::Value>::kIsArray) {
      for (const auto element : value) {
        store_le<typename F::Scalar>(out, at, element);
        at += sizeof element;
      }
    } else {
      store_le<typename F::Scalar>(out, at, value);
      at += sizeof value;
    }
  });
  return out;
}

/// Of a payload as it came: zeros that were left out at its end are put back, what is longer than the message
/// was added to it later and is not looked at.
template <class M>
[[nodiscard]] M message_of(std::span<const std::uint8_t> payload) {
  std::array<std::uint8_t, Definition<M>::kSize> whole{};
  std::copy_n(payload.begin(), std::min(payload.size(), whole.size()), whole.begin());
  M out;
  std::size_t at = 0;
  Definition<M>::for_each([&](const auto& field) {
    using F = std::decay_t<decltype(field)>;
    auto& value = out.*(field.member);
    if constexpr (detail::Element<typename F::Value>::kIsArray) {
      for (auto& element : value) {
        element = load_le<typename F::Scalar>(whole, at);
        at += sizeof element;
      }
    } else {
      value = load_le<typename F::Scalar>(whole, at);
      at += sizeof value;
    }
  });
  return out;
}

}  // namespace fathom::mavlink
