#include "logs/ulog/format.hpp"

#include <array>
#include <charconv>
#include <utility>

#include "base/bytes/little_endian.hpp"

namespace fathom::logs::ulog {
namespace {

constexpr std::size_t kLargest = 65535;  // what the size of a message can say
constexpr int kDeepest = 16;

struct BasicRow {
  std::string_view word;
  Basic type;
  std::size_t size;
};
constexpr std::array<BasicRow, 12> kBasics{{{"int8_t", Basic::i8, 1},
                                            {"uint8_t", Basic::u8, 1},
                                            {"int16_t", Basic::i16, 2},
                                            {"uint16_t", Basic::u16, 2},
                                            {"int32_t", Basic::i32, 4},
                                            {"uint32_t", Basic::u32, 4},
                                            {"int64_t", Basic::i64, 8},
                                            {"uint64_t", Basic::u64, 8},
                                            {"float", Basic::f32, 4},
                                            {"double", Basic::f64, 8},
                                            {"bool", Basic::boolean, 1},
                                            {"char", Basic::character, 1}}};

bool is_padding(const Field& field) {
  return field.name.starts_with("_padding");
}

bool is_unsigned(Basic type) {
  return type == Basic::u64 || type == Basic::u32 || type == Basic::u16 || type == Basic::u8;
}

bool spelled(std::string_view word, std::string_view more) {
  if (word.empty()) return false;
  for (const char c : word) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (!plain && more.find(c) == std::string_view::npos) return false;
  }
  return true;
}

class Builder {
 public:
  explicit Builder(const std::map<std::string, Format>& formats) : formats_(formats) {}

  // Empty when it worked, else what is wrong.
  std::string add(const std::string& name, const std::string& prefix, bool hidden, int depth) {
    if (depth > kDeepest) return "format " + name + " contains itself, or is nested too deep";
    const auto found = formats_.find(name);
    if (found == formats_.end()) return "format " + name + " is not defined";
    for (const Field& field : found->second.fields) {
      const std::size_t begin = out.size;
      const std::size_t times = field.count == 0 ? 1 : field.count;
      for (std::size_t i = 0; i < times; ++i) {
        const std::string label =
            prefix + field.name + (field.count == 0 ? "" : "[" + std::to_string(i) + "]");
        if (std::string wrong = add_one(field, label, hidden || is_padding(field), depth); !wrong.empty())
          return wrong;
        if (out.size == begin) return "field " + label + " has no size";
        if (out.size > kLargest) return "format " + name + " is larger than a message can be";
      }
      if (depth == 0 && !is_padding(field)) out.least = out.size;
    }
    return {};
  }
  Layout out;

 private:
  std::string add_one(const Field& field, const std::string& label, bool hidden, int depth) {
    const auto basic = basic_named(field.type);
    if (!basic) return add(field.type, label + ".", hidden, depth + 1);
    const Layout::Column column{label, *basic, out.size};
    if (depth == 0 && field.count == 0 && label == "timestamp" && is_unsigned(*basic)) out.timestamp = column;
    if (!hidden && *basic != Basic::character) out.columns.push_back(column);
    out.size += size_of(*basic);
    return {};
  }

  const std::map<std::string, Format>& formats_;
};

}  // namespace

std::optional<Basic> basic_named(std::string_view word) {
  for (const BasicRow& row : kBasics) {
    if (row.word == word) return row.type;
  }
  return std::nullopt;
}

std::size_t size_of(Basic type) {
  return kBasics[static_cast<std::size_t>(type)].size;
}

double number(Basic type, std::span<const std::uint8_t> bytes, std::size_t offset) {
  switch (type) {
    case Basic::i8:
      return load_le<std::int8_t>(bytes, offset);
    case Basic::u8:
    case Basic::character:
      return load_le<std::uint8_t>(bytes, offset);
    case Basic::boolean:
      return load_le<std::uint8_t>(bytes, offset) != 0 ? 1.0 : 0.0;
    case Basic::i16:
      return load_le<std::int16_t>(bytes, offset);
    case Basic::u16:
      return load_le<std::uint16_t>(bytes, offset);
    case Basic::i32:
      return load_le<std::int32_t>(bytes, offset);
    case Basic::u32:
      return load_le<std::uint32_t>(bytes, offset);
    case Basic::i64:
      return static_cast<double>(load_le<std::int64_t>(bytes, offset));
    case Basic::u64:
      return static_cast<double>(load_le<std::uint64_t>(bytes, offset));
    case Basic::f32:
      return static_cast<double>(load_le<float>(bytes, offset));
    case Basic::f64:
      return load_le<double>(bytes, offset);
  }
  return 0.0;
}

Result<Field> parse_field(std::string_view text) {
  const auto wrong = [&](const std::string& why) {
    return Error{"field '" + std::string(text) + "' " + why};
  };
  const std::size_t space = text.find(' ');
  if (space == std::string_view::npos) return wrong("has no name, expected TYPE NAME");
  Field field;
  std::string_view type = text.substr(0, space);
  field.name = std::string(text.substr(space + 1));
  if (!spelled(field.name, "-/")) return wrong("has a name of other letters than a-z A-Z 0-9 _");
  if (const std::size_t bracket = type.find('['); bracket != std::string_view::npos) {
    const std::string_view digits = type.substr(bracket + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), field.count);
    // An empty text is written as char[0].
    if (error != std::errc{} || end + 1 != digits.data() + digits.size() || *end != ']' ||
        (field.count == 0 && type.substr(0, bracket) != "char") || field.count > kLargest)
      return wrong("has an array length that is none, expected TYPE[1..65535]");
    type = type.substr(0, bracket);
  }
  if (!spelled(type, "-/")) return wrong("has no type");
  field.type = std::string(type);
  return field;
}

Result<Format> parse_format(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || !spelled(text.substr(0, colon), "-/"))
    return Error{"format '" + std::string(text.substr(0, 40)) + "' has no name, expected NAME:FIELDS"};
  Format format;
  format.name = std::string(text.substr(0, colon));
  std::string_view rest = text.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t semicolon = rest.find(';');
    const std::string_view one = rest.substr(0, semicolon);
    rest = semicolon == std::string_view::npos ? std::string_view{} : rest.substr(semicolon + 1);
    if (one.empty()) continue;
    Result<Field> field = parse_field(one);
    if (!field) return Error{"format " + format.name + ": " + field.error().message};
    if (one.find("[0]") != std::string_view::npos)
      return Error{"format " + format.name + ": field '" + std::string(one) + "' is an array of nothing"};
    format.fields.push_back(std::move(field.value()));
  }
  if (format.fields.empty()) return Error{"format " + format.name + " has no fields"};
  return format;
}

Result<Layout> layout_of(const std::map<std::string, Format>& formats, const std::string& name) {
  Builder builder(formats);
  if (std::string wrong = builder.add(name, "", false, 0); !wrong.empty()) return Error{std::move(wrong)};
  return builder.out;
}

}  // namespace fathom::logs::ulog
