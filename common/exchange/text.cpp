#include "exchange/text.hpp"

#include <array>
#include <charconv>

#include "base/markup.hpp"

namespace fathom::exchange {

std::string decimals(double value, int count) {
  std::array<char, 350> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, count);
  std::string out(text.data(), end);
  if (out.starts_with('-') && out.find_first_not_of("-0.") == std::string::npos) out.erase(0, 1);
  return out;
}

std::string plain(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E) c = '?';
  return escaped(out);
}

}  // namespace fathom::exchange
