#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace fathom::codec {

/// Decimal number as instruments write it: optional sign, digits, at most one point, at least one digit.
/// Nothing for anything else: blanks, exponents, "nan", "inf", trailing text. Independent of the locale.
[[nodiscard]] std::optional<double> parse_decimal(std::string_view text);

/// Unsigned integer of decimal digits only, at most nine of them.
[[nodiscard]] std::optional<std::uint32_t> parse_digits(std::string_view text);

/// Value of two hexadecimal digits, either case.
[[nodiscard]] std::optional<std::uint8_t> parse_hex_byte(char high, char low);

/// `text` without blanks and tabs at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

[[nodiscard]] constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

[[nodiscard]] constexpr bool is_line_end(char c) {
  return c == '\r' || c == '\n';
}

}  // namespace fathom::codec
