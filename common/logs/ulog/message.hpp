#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "logs/ulog/format.hpp"

/// The messages of a ULog file, one by one: 2 bytes of size, one of type, the payload.
namespace fathom::logs::ulog {

inline constexpr std::size_t kHeaderSize = 3;
inline constexpr std::size_t kLongestMessage = kHeaderSize + 65535;
inline constexpr std::array<std::uint8_t, 8> kSyncMagic{0x2F, 0x73, 0x13, 0x20, 0x25, 0x0C, 0xBB, 0x12};

/// What an id in the data means.
struct Subscription {
  std::string topic;
  unsigned instance = 0;
  std::optional<Layout> layout;  ///< nothing while its format is unknown
  std::size_t series = 0;        ///< where its rows go; the reader's
};
using Subscriptions = std::map<std::uint16_t, Subscription>;

enum class Fault : std::uint8_t {
  none,
  cut,        ///< longer than what is left
  malformed,  ///< its payload is not what its type has
  unknown_type,
  unknown_id,   ///< data without a subscription or without a format
  wrong_length  ///< data of another length than the format says
};

/// One message at the beginning of `bytes`.
struct Message {
  char type = 0;
  std::span<const std::uint8_t> payload;
  Fault fault = Fault::none;
  [[nodiscard]] std::size_t size() const { return kHeaderSize + payload.size(); }
};

/// `bytes` ends where the section does. Everything that can be held against a message without reading the
/// next one is held against it: garbage has a fault nearly always.
[[nodiscard]] Message look(std::span<const std::uint8_t> bytes, const Subscriptions& subscriptions);

[[nodiscard]] std::string_view text_of(std::span<const std::uint8_t> bytes);

/// key and value of an information or a parameter. `skip`: bytes before the length of the key.
struct KeyValue {
  Field key;
  std::span<const std::uint8_t> value;
};
[[nodiscard]] std::optional<KeyValue> key_value(std::span<const std::uint8_t> payload, std::size_t skip);
/// A number, several with blanks between, or the characters.
[[nodiscard]] std::string value_text(const KeyValue& pair);
[[nodiscard]] std::optional<double> value_number(const KeyValue& pair);

}  // namespace fathom::logs::ulog
