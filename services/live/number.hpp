#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace fathom::cli {

/// A number as printf's format has it, or "-" when it is unknown.
[[nodiscard]] inline std::string number(const char* format, double value) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 64> text{};
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
  std::snprintf(text.data(), text.size(), format, value);
#pragma GCC diagnostic pop
  return text.data();
}

}  // namespace fathom::cli
