#pragma once

#include <string>
#include <vector>

#include "status/view.hpp"

namespace fathom::cli {

/// Lines of at most `width` columns, with colours by escape sequences or without.
[[nodiscard]] std::vector<std::string> table(const status::StatusView& view, int width, bool colour);

}  // namespace fathom::cli
