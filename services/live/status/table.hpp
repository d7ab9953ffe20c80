#pragma once

#include <limits>
#include <string>
#include <vector>

#include "status/view.hpp"

namespace fathom::cli {

/// A width at which nothing is cut, not even the name of an alarm.
inline constexpr int kUncut = std::numeric_limits<int>::max();

/// Columns of the terminal that a descriptor is; kUncut where it is none, as a pipe or a file.
[[nodiscard]] int width_of(int descriptor);

/// Lines of at most `width` columns, with colours by escape sequences or without.
[[nodiscard]] std::vector<std::string> table(const status::StatusView& view, int width, bool colour);

}  // namespace fathom::cli
