#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "dataset/score.hpp"

namespace fathom::cli {

/// A number of JSON; null where it is unknown.
template <class Json>
[[nodiscard]] Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// Errors of one quantity, in its unit times the factor.
template <class Json>
[[nodiscard]] Json figures(const dataset::ErrorFigures& f, double factor = 1.0) {
  return {{"rms", number<Json>(f.rms * factor)},
          {"p95", number<Json>(f.p95 * factor)},
          {"max", number<Json>(f.max * factor)},
          {"end", number<Json>(f.end * factor)}};
}

/// A line of the terminal, of 299 characters at most.
template <class... Arguments>
[[nodiscard]] std::string line(const char* format, Arguments... arguments) {
  std::array<char, 300> text{};
  std::snprintf(text.data(), text.size(), format, arguments...);
  return std::string(text.data()) + "\n";
}

}  // namespace fathom::cli
