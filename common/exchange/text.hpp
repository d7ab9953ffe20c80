#pragma once

#include <string>
#include <string_view>

namespace fathom::exchange {

/// With a fixed count of decimals, never "-0.00".
[[nodiscard]] std::string decimals(double value, int count);

/// Escaped text of ASCII alone: other characters become '?'.
[[nodiscard]] std::string plain(std::string_view text);

}  // namespace fathom::exchange
