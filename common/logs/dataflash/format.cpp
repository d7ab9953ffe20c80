#include "logs/dataflash/format.hpp"

#include <algorithm>
#include <cmath>

#include "base/bytes/little_endian.hpp"

namespace fathom::logs::dataflash {
namespace {

std::string fixed_text(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    if (byte == 0) break;
    text += byte >= ' ' && byte <= '~' ? static_cast<char>(byte) : '?';
  }
  return text;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    out.push_back(text.substr(begin, comma - begin));
    begin = comma + 1;
  }
  return out;
}

}  // namespace

std::optional<std::size_t> Definition::find(std::string_view label) const {
  const auto found = std::find(labels.begin(), labels.end(), label);
  if (found == labels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - labels.begin());
}

Letters::Letters()
    : multiplier{{'?', 1.0},  {'2', 1e2},  {'1', 1e1},  {'0', 1.0},  {'A', 1e-1}, {'B', 1e-2}, {'C', 1e-3},
                 {'D', 1e-4}, {'E', 1e-5}, {'F', 1e-6}, {'G', 1e-7}, {'I', 1e-9}, {'!', 3.6},  {'/', 3600.0}},
      unit{{'d', "deg"},   {'k', "deg/s"}, {'D', "deglatitude"}, {'U', "deglongitude"},
           {'E', "rad/s"}, {'G', "Gauss"}, {'h', "degheading"},  {'m', "m"},
           {'n', "m/s"},   {'o', "m/s/s"}, {'O', "degC"},        {'P', "Pa"},
           {'r', "rad"},   {'s', "s"},     {'#', "instance"}} {}

std::size_t size_of(char letter) {
  switch (letter) {
    case 'b':
    case 'B':
    case 'M':
      return 1;
    case 'h':
    case 'H':
    case 'c':
    case 'C':
    case 'g':  // half precision
      return 2;
    case 'i':
    case 'I':
    case 'e':
    case 'E':
    case 'L':
    case 'f':
    case 'n':
      return 4;
    case 'd':
    case 'q':
    case 'Q':
      return 8;
    case 'N':
      return 16;
    case 'Z':
    case 'a':
      return 64;
    default:
      return 0;
  }
}

bool is_text(char letter) {
  return letter == 'n' || letter == 'N' || letter == 'Z' || letter == 'a';
}

std::optional<Defined> parse_format(std::span<const std::uint8_t> payload) {
  if (payload.size() < kFormatLength - kHeaderSize) return std::nullopt;
  Defined out;
  out.type = payload[0];
  Definition& d = out.definition;
  d.length = payload[1];
  d.name = fixed_text(payload.subspan(2, 4));
  d.letters = fixed_text(payload.subspan(6, 16));
  d.labels = split(fixed_text(payload.subspan(22, 64)));
  const auto is_word = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (d.length < kHeaderSize || d.name.empty() || !std::all_of(d.name.begin(), d.name.end(), is_word))
    return std::nullopt;
  std::size_t at = 0;
  for (const char letter : d.letters) {
    if (size_of(letter) == 0) d.fault = std::string("field type '") + letter + "' is not known";
    d.offsets.push_back(at);
    at += size_of(letter);
  }
  if (d.fault.empty() && d.labels.size() != d.letters.size()) {
    d.fault = std::to_string(d.labels.size()) + " labels for " + std::to_string(d.letters.size()) + " fields";
  }
  if (d.fault.empty() && at + kHeaderSize != d.length) {
    d.fault = "its fields have " + std::to_string(at + kHeaderSize) + " bytes, its length says " +
              std::to_string(d.length);
  }
  return out;
}

double raw_number(char letter, std::span<const std::uint8_t> payload, std::size_t offset) {
  switch (letter) {
    case 'b':
      return load_le<std::int8_t>(payload, offset);
    case 'B':
    case 'M':
      return load_le<std::uint8_t>(payload, offset);
    case 'h':
    case 'c':
      return load_le<std::int16_t>(payload, offset);
    case 'H':
    case 'C':
      return load_le<std::uint16_t>(payload, offset);
    case 'i':
    case 'e':
    case 'L':
      return load_le<std::int32_t>(payload, offset);
    case 'I':
    case 'E':
      return load_le<std::uint32_t>(payload, offset);
    case 'f':
      return static_cast<double>(load_le<float>(payload, offset));
    case 'd':
      return load_le<double>(payload, offset);
    case 'q':
      return static_cast<double>(load_le<std::int64_t>(payload, offset));
    case 'Q':
      return static_cast<double>(load_le<std::uint64_t>(payload, offset));
    case 'g': {
      const auto bits = load_le<std::uint16_t>(payload, offset);
      const double sign = (bits & 0x8000U) != 0 ? -1.0 : 1.0;
      const unsigned exponent = (bits >> 10U) & 0x1FU;
      const double fraction = static_cast<double>(bits & 0x3FFU) / 1024.0;
      if (exponent == 0) return sign * std::ldexp(fraction, -14);
      if (exponent == 31) return fraction == 0.0 ? sign * HUGE_VAL : std::nan("");
      return sign * std::ldexp(1.0 + fraction, static_cast<int>(exponent) - 15);
    }
    default:
      return 0.0;
  }
}

double scale_of(const Definition& definition, std::size_t field, const Letters& letters) {
  if (field < definition.multipliers.size()) {
    const auto found = letters.multiplier.find(definition.multipliers[field]);
    // '-' and '?' say that there is none or that nobody knows: the letter of the field counts then.
    if (found != letters.multiplier.end() && found->first != '?' && found->first != '-' &&
        found->second > 0.0)
      return found->second;
  }
  switch (definition.letters[field]) {
    case 'c':
    case 'C':
    case 'e':
    case 'E':
      return 1e-2;
    case 'L':
      return 1e-7;
    default:
      return 1.0;
  }
}

std::string text_at(char letter, std::span<const std::uint8_t> payload, std::size_t offset) {
  return fixed_text(payload.subspan(offset, size_of(letter)));
}

}  // namespace fathom::logs::dataflash
