#include "base/field.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace fathom {
namespace {

std::string number_text(double value, bool integer) {
  std::array<char, 32> text{};
  const auto result =
      integer && std::abs(value) < 9e15
          ? std::to_chars(text.data(), text.data() + text.size(), static_cast<std::int64_t>(value))
          : std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

}  // namespace

bool FieldInfo::known_to(const std::string& choice) const {
  return only_for.empty() || std::find(only_for.begin(), only_for.end(), choice) != only_for.end();
}

std::string range_text(double low, double high, bool integer) {
  const bool has_low = std::isfinite(low);
  const bool has_high = std::isfinite(high);
  if (has_low && has_high) return " from " + number_text(low, integer) + " to " + number_text(high, integer);
  if (has_low) return " of at least " + number_text(low, integer);
  if (has_high) return " of at most " + number_text(high, integer);
  return "";
}

std::string list_words(const std::vector<std::string>& words) {
  std::string out;
  for (const auto& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

}  // namespace fathom
