#pragma once

#include <string>

namespace fathom::cli {

/// Words in a row, with commas between them.
template <class Words>
[[nodiscard]] std::string listed(const Words& words) {
  std::string out;
  for (const auto& word : words) {
    if (!out.empty()) out += ", ";
    out += word;
  }
  return out;
}

}  // namespace fathom::cli
