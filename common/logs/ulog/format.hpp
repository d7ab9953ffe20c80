#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

/// The self-description of ULog: messages that say how other messages are laid out.
namespace fathom::logs::ulog {

enum class Basic : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64, boolean, character };

[[nodiscard]] std::optional<Basic> basic_named(std::string_view word);
[[nodiscard]] std::size_t size_of(Basic type);
/// Precondition: the bytes are there.
[[nodiscard]] double number(Basic type, std::span<const std::uint8_t> bytes, std::size_t offset);

struct Field {
  std::string type;       ///< a basic type, or the name of another format
  std::size_t count = 0;  ///< elements of an array; 0: no array
  std::string name;
};
struct Format {
  std::string name;
  std::vector<Field> fields;
};

/// "type name", "type[N] name".
[[nodiscard]] Result<Field> parse_field(std::string_view text);
/// "name:type field;type[N] field;".
[[nodiscard]] Result<Format> parse_format(std::string_view text);

/// Where the numbers of a message stand. Arrays and nested messages are spelled out: "a[2]", "b.c",
/// "b[1].c"; padding and characters have no column.
struct Layout {
  struct Column {
    std::string name;
    Basic type = Basic::u8;
    std::size_t offset = 0;
  };
  std::vector<Column> columns;
  std::size_t size = 0;
  std::size_t least = 0;  ///< without the padding at the end, which may not be logged
  std::optional<Column> timestamp;
};

/// Fails where a format is missing, contains itself, or is larger than any message.
[[nodiscard]] Result<Layout> layout_of(const std::map<std::string, Format>& formats, const std::string& name);

}  // namespace fathom::logs::ulog
