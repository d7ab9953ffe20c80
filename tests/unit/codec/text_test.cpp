#include <string>

#include <gtest/gtest.h>

#include "codec/text/numbers.hpp"

namespace fathom::codec {
namespace {

TEST(ParseDecimal, ReadsWhatInstrumentsWrite) {
  EXPECT_EQ(parse_decimal("12.5"), 12.5);
  EXPECT_EQ(parse_decimal("-0.25"), -0.25);
  EXPECT_EQ(parse_decimal("+00.40"), 0.4);
  EXPECT_EQ(parse_decimal("007"), 7.0);
  EXPECT_EQ(parse_decimal(".5"), 0.5);
  EXPECT_EQ(parse_decimal("5."), 5.0);
}

TEST(ParseDecimal, RefusesEverythingElse) {
  for (const char* text : {"",   "-",  "+",   ".",     "-.",  "nan", "NaN", "inf",    "-inf",  "1e3", "0x10",
                           "1 ", " 1", "1,5", "1.2.3", "--1", "+-1", "1-",  "2208-1", "X.138", "12a"}) {
    EXPECT_FALSE(parse_decimal(text).has_value()) << text;
  }
}

TEST(ParseDecimal, AHugeNumberIsAnInfinityNobodyMeant) {
  EXPECT_FALSE(parse_decimal(std::string(400, '9')).has_value());
}

TEST(ParseDigits, RefusesSignsBlanksAndOverflow) {
  EXPECT_EQ(parse_digits("081411"), 81411U);
  for (const char* text : {"", "-1", "+1", " 1", "1.0", "1234567890"}) {
    EXPECT_FALSE(parse_digits(text).has_value()) << text;
  }
}

TEST(ParseHexByte, EitherCase) {
  EXPECT_EQ(parse_hex_byte('6', 'b'), 0x6B);
  EXPECT_EQ(parse_hex_byte('F', '0'), 0xF0);
  EXPECT_FALSE(parse_hex_byte('G', '0').has_value());
  EXPECT_FALSE(parse_hex_byte('0', ' ').has_value());
}

TEST(Trimmed, LeavesTheInsideAlone) {
  EXPECT_EQ(trimmed(" \t1 2\t "), "1 2");
  EXPECT_EQ(trimmed(" \t "), "");
}

}  // namespace
}  // namespace fathom::codec
