#include "config/explain.hpp"

#include <algorithm>
#include <array>

namespace fathom::config {
namespace {

using Cells = std::array<std::string, 5>;

Cells cells_of(const FieldRow& row) {
  const std::string standard = row.info.required ? "required"
                               : row.info.required_for.empty()
                                   ? row.default_text
                                   : "required for " + list_words(row.info.required_for);
  return {row.key, row.info.unit, row.range, standard, row.info.sentence};
}

// Characters, where a text is UTF-8.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace

std::string explain_text(const std::vector<FieldRow>& rows) {
  // A cell that is wider pushes the rest of its own line aside, not every line.
  constexpr std::array<std::size_t, 4> kWidest{60, 12, 44, 40};
  std::vector<Cells> lines{{"KEY", "UNIT", "RANGE", "DEFAULT", "MEANING"}};
  for (const FieldRow& row : rows) lines.push_back(cells_of(row));
  std::array<std::size_t, 4> width{};
  for (const Cells& line : lines) {
    for (std::size_t i = 0; i < width.size(); ++i)
      width[i] = std::max(width[i], std::min(width_of(line[i]), kWidest[i]));
  }
  std::string out;
  for (const Cells& line : lines) {
    for (std::size_t i = 0; i < width.size(); ++i) {
      out += line[i];
      out.append(std::max(width[i], width_of(line[i])) - width_of(line[i]) + 2, ' ');
    }
    out += line.back() + "\n";
  }
  return out;
}

}  // namespace fathom::config
