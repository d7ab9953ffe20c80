#include "archive/reader.hpp"

#include <cmath>
#include <cstdio>

namespace fathom::archive {
namespace {

std::string text_of(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

std::string expectation(Range limit) {
  constexpr double kMost = std::numeric_limits<double>::max();
  std::string out = "a finite number";
  if (limit.least == 0.0 && limit.most == kMost) {
    out = "a finite number that is not negative";
  } else if (limit.least > -kMost || limit.most < kMost) {
    out = text_of(limit.least) + " to " + text_of(limit.most);
  }
  return limit.or_unknown ? out + ", or unknown," : out;
}

}  // namespace

void Reader::refuse(const char* name, std::string_view found, std::string_view expected) {
  std::string where;
  for (std::size_t i = 0; i < std::min(depth_, path_.size()); ++i) {
    const Level& level = path_[i];
    if (!where.empty() && *level.name != '\0') where += '.';
    where += level.name;
    if (level.index != kAlone) where += "[" + std::to_string(level.index) + "]";
  }
  if (!where.empty() && *name != '\0') where += '.';
  where += name;
  complaint_ = where + (found.empty() ? ": " : " is " + std::string(found) + ", ");
  complaint_ += std::string(expected) + " was expected";
  bytes_ = {};
}

bool Reader::outside(const char* name, std::int64_t value, Whole limit) {
  if (value >= limit.least && value <= limit.most) return false;
  refuse(name, std::to_string(value), std::to_string(limit.least) + " to " + std::to_string(limit.most));
  return true;
}

void Reader::expect_end() {
  if (good() && !bytes_.empty()) refuse("", std::to_string(bytes_.size()) + " bytes too long", "its end");
}

void Reader::flag(const char* name, bool& value) {
  const auto found = take<std::uint8_t>(name);
  if (!good() || outside(name, found, {0, 1})) return;
  value = found == 1;
}

void Reader::number(const char* name, double& value, Range limit) {
  const auto found = std::bit_cast<double>(take<std::uint64_t>(name));
  if (!good()) return;
  const bool fits = limit.any || (limit.or_unknown && std::isnan(found)) ||
                    (found >= limit.least && found <= limit.most);  // false for NaN
  if (!fits) return refuse(name, text_of(found), expectation(limit));
  value = found;
}

void Reader::name(const char* name, Name& value) {
  const auto size = take<std::uint8_t>(name);
  if (!good() || outside(name, size, {0, static_cast<std::int64_t>(Name::kCapacity)})) return;
  if (bytes_.size() < size) return refuse(name, "cut off", "more bytes");
  std::array<char, Name::kCapacity> text{};
  for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>(bytes_[i]);
  bytes_ = bytes_.subspan(size);
  value = Name(std::string_view(text.data(), size));
}

}  // namespace fathom::archive
