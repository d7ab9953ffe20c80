#include "logs/ros2/cdr.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <type_traits>

#include "base/unknown.hpp"

namespace fathom::logs::ros2 {
namespace {

constexpr std::size_t kEncapsulation = 4;
/// Bytes that may follow the last field: it is filled up to a multiple of 4.
constexpr std::size_t kMostPadding = 3;

template <class T>
T flipped(T value) {
  auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
  std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

class Decoder {
 public:
  Decoder(std::span<const std::uint8_t> bytes, bool swapped, Row& row)
      : bytes_(bytes), swapped_(swapped), row_(row) {}

  // False at a fault. `column` and `text`: where the message's first ones stand; with `keep` false none does.
  bool message(const Node& node, std::size_t column, std::size_t text, bool keep) {
    for (const Node& member : node.members) {
      std::size_t count = member.array == Node::Array::fixed ? member.count : 1;
      if (member.array == Node::Array::sequence) {
        if (!length_of(member, count)) return false;
        if (keep) row_.values[column] = static_cast<double>(count);
        ++column;
      }
      for (std::size_t i = 0; i < count; ++i) {
        const bool kept = keep && i < member.kept;
        const std::size_t at_column = column + i * member.columns;
        const std::size_t at_text = text + i * member.texts;
        if (member.basic ? !basic(member, at_column, at_text, kept)
                         : !message(member, at_column, at_text, kept)) {
          fault_field_ = "." + member.name +
                         (member.array == Node::Array::none ? "" : "[" + std::to_string(i) + "]") +
                         fault_field_;
          return false;
        }
      }
      column += member.columns * member.kept;
      text += member.texts * member.kept;
    }
    return true;
  }

  [[nodiscard]] std::string fault() const {
    return "field " + (fault_field_.empty() ? "?" : fault_field_.substr(1)) + ": offset " +
           std::to_string(kEncapsulation + at_) + ": " + fault_;
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

 private:
  bool length_of(const Node& node, std::size_t& count) {
    std::uint32_t length = 0;
    const bool read = number(length);
    // Every element has a byte at least: a length beyond what is left is none.
    if (read && length > left()) {
      fault_ = "a sequence of " + std::to_string(length) + " elements, but " + std::to_string(left()) +
               " bytes are left";
    } else if (read && node.bounded && length > node.count) {
      fault_ = "a sequence of " + std::to_string(length) + " elements, expected at most " +
               std::to_string(node.count);
    }
    if (!fault_.empty()) {
      fault_field_ = "." + node.name;
      return false;
    }
    count = length;
    return true;
  }

  bool basic(const Node& node, std::size_t column, std::size_t text, bool keep) {
    switch (*node.basic) {
      case Basic::boolean:
      case Basic::u8:
        return value<std::uint8_t>(column, keep);
      case Basic::i8:
        return value<std::int8_t>(column, keep);
      case Basic::i16:
        return value<std::int16_t>(column, keep);
      case Basic::u16:
        return value<std::uint16_t>(column, keep);
      case Basic::i32:
        return value<std::int32_t>(column, keep);
      case Basic::u32:
        return value<std::uint32_t>(column, keep);
      case Basic::i64:
        return value<std::int64_t>(column, keep);
      case Basic::u64:
        return value<std::uint64_t>(column, keep);
      case Basic::f32:
        return value<float>(column, keep);
      case Basic::f64:
        return value<double>(column, keep);
      case Basic::string:
        return string(node, text, keep);
    }
    return false;
  }

  template <class T>
  bool value(std::size_t column, bool keep) {
    T value{};
    if (!number(value)) return false;
    if (keep) row_.values[column] = static_cast<double>(value);
    return true;
  }

  bool string(const Node& node, std::size_t text, bool keep) {
    std::uint32_t length = 0;
    if (!number(length)) return false;
    if (length > left()) {
      fault_ =
          "a string of " + std::to_string(length) + " bytes, but " + std::to_string(left()) + " are left";
      return false;
    }
    const auto all = bytes_.subspan(at_, length);
    std::string_view letters(reinterpret_cast<const char*>(all.data()), all.size());
    // The zero at its end is counted. Some write an empty string as no bytes at all.
    if (!letters.empty()) {
      if (letters.back() != '\0') {
        fault_ = "a string without the zero at its end";
        return false;
      }
      letters.remove_suffix(1);
    }
    if (node.longest > 0 && letters.size() > node.longest) {
      fault_ = "a string of " + std::to_string(letters.size()) + " letters, expected at most " +
               std::to_string(node.longest);
      return false;
    }
    at_ += length;
    if (keep) row_.texts[text] = letters;
    return true;
  }

  template <class T>
  bool number(T& value) {
    const std::size_t at = (at_ + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    if (at > bytes_.size() || bytes_.size() - at < sizeof(T)) {
      fault_ = "the message ends, expected " + std::to_string(sizeof(T)) + " bytes more";
      return false;
    }
    std::memcpy(&value, bytes_.data() + at, sizeof(T));
    if (swapped_) value = flipped(value);
    at_ = at + sizeof(T);
    return true;
  }

  std::span<const std::uint8_t> bytes_;
  bool swapped_;
  Row& row_;
  std::size_t at_ = 0;
  std::string fault_;
  std::string fault_field_;
};

}  // namespace

std::string decode(const Schema& schema, std::span<const std::uint8_t> message, Row& row) {
  row.values.assign(schema.columns.size(), kUnknown);
  row.texts.assign(schema.texts.size(), {});
  if (message.size() < kEncapsulation)
    return std::to_string(message.size()) + " bytes, expected an encapsulation header of 4";
  if (message[0] != 0 || message[1] > 1) {
    std::array<char, 8> kind{};
    std::snprintf(kind.data(), kind.size(), "0x%02x%02x", message[0], message[1]);
    return "encapsulation " + std::string(kind.data()) + ", expected 0x0000 or 0x0001: plain CDR";
  }
  const bool little = message[1] == 1;
  Decoder decoder(message.subspan(kEncapsulation), little != (std::endian::native == std::endian::little),
                  row);
  if (!decoder.message(schema.root, 0, 0, true)) return decoder.fault();
  if (decoder.left() > kMostPadding)
    return std::to_string(decoder.left()) +
           " bytes behind the last field, expected none: the definition is another one";
  return {};
}

}  // namespace fathom::logs::ros2
