#include "logs/ulog/message.hpp"

#include <algorithm>

#include "base/bytes/little_endian.hpp"

namespace fathom::logs::ulog {
namespace {

bool printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

bool is_name(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '/';
  });
}

bool is_level(std::uint8_t level) {
  return (level >= '0' && level <= '7') || level <= 7;
}

Fault fault_of_data(std::span<const std::uint8_t> payload, const Subscriptions& subscriptions) {
  if (payload.size() < 2) return Fault::malformed;
  const auto found = subscriptions.find(load_le<std::uint16_t>(payload, 0));
  if (found == subscriptions.end() || !found->second.layout) return Fault::unknown_id;
  const std::size_t length = payload.size() - 2;
  const Layout& layout = *found->second.layout;
  return length >= layout.least && length <= layout.size ? Fault::none : Fault::wrong_length;
}

Fault fault_of(char type, std::span<const std::uint8_t> payload, const Subscriptions& subscriptions) {
  const auto that = [](bool sound) { return sound ? Fault::none : Fault::malformed; };
  switch (type) {
    case 'D':
      return fault_of_data(payload, subscriptions);
    case 'S':
      return that(payload.size() >= kSyncMagic.size() &&
                  std::equal(kSyncMagic.begin(), kSyncMagic.end(), payload.begin()));
    case 'A':
      return that(payload.size() > 3 && is_name(text_of(payload.subspan(3))));
    case 'R':
    case 'O':
      return that(payload.size() == 2);
    case 'L':
      return that(payload.size() >= 9 && is_level(payload[0]));
    case 'C':
      return that(payload.size() >= 11 && is_level(payload[0]));
    case 'I':
    case 'P':
      return that(key_value(payload, 0).has_value());
    case 'M':
    case 'Q':
      return that(key_value(payload, 1).has_value());
    case 'F':
      return that(printable(text_of(payload)) && text_of(payload).find(':') != std::string_view::npos);
    case 'B':
      return that(payload.size() >= 40);
    default:
      return Fault::unknown_type;
  }
}

}  // namespace

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Message look(std::span<const std::uint8_t> bytes, const Subscriptions& subscriptions) {
  Message message;
  if (bytes.size() < kHeaderSize) {
    message.fault = Fault::cut;
    return message;
  }
  const std::size_t length = load_le<std::uint16_t>(bytes, 0);
  message.type = static_cast<char>(bytes[2]);
  if (kHeaderSize + length > bytes.size()) {
    message.fault = Fault::cut;
    return message;
  }
  message.payload = bytes.subspan(kHeaderSize, length);
  message.fault = fault_of(message.type, message.payload, subscriptions);
  return message;
}

std::optional<KeyValue> key_value(std::span<const std::uint8_t> payload, std::size_t skip) {
  if (payload.size() < skip + 1) return std::nullopt;
  const std::size_t key_length = payload[skip];
  if (key_length == 0 || payload.size() < skip + 1 + key_length) return std::nullopt;
  Result<Field> key = parse_field(text_of(payload.subspan(skip + 1, key_length)));
  if (!key || !basic_named(key.value().type)) return std::nullopt;
  KeyValue pair;
  pair.value = payload.subspan(skip + 1 + key_length);
  const std::size_t count = key.value().count == 0 ? 1 : key.value().count;
  const bool characters = key.value().type == "char";
  // Loggers cut long texts without telling the key.
  if (!characters && pair.value.size() < count * size_of(*basic_named(key.value().type))) return std::nullopt;
  pair.key = std::move(key.value());
  return pair;
}

std::string value_text(const KeyValue& pair) {
  if (pair.key.type == "char") {
    std::string text;
    for (const char c : text_of(pair.value)) {
      if (c == '\0') break;
      text += static_cast<unsigned char>(c) >= ' ' || c == '\n' || c == '\t' ? c : '?';
    }
    return text;
  }
  const Basic type = *basic_named(pair.key.type);
  const std::size_t count = pair.key.count == 0 ? 1 : pair.key.count;
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    std::string one = std::to_string(number(type, pair.value, i * size_of(type)));
    if (one.find('.') != std::string::npos) {
      one.erase(one.find_last_not_of('0') + 1);
      if (one.back() == '.') one.pop_back();
    }
    text += (i == 0 ? "" : " ") + one;
  }
  return text;
}

std::optional<double> value_number(const KeyValue& pair) {
  if (pair.key.type == "char" || pair.key.count > 1) return std::nullopt;
  return number(*basic_named(pair.key.type), pair.value, 0);
}

}  // namespace fathom::logs::ulog
