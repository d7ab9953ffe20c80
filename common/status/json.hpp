#pragma once

#include <string>

#include "status/view.hpp"

namespace fathom::status {

/// One line of JSON; unknown numbers are null.
[[nodiscard]] std::string json_line(const StatusView& view);

}  // namespace fathom::status
