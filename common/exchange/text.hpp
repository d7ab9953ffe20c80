#pragma once

#include <string>
#include <string_view>

namespace fathom::exchange {

/// With a fixed count of decimals, never "-0.00".
[[nodiscard]] std::string decimals(double value, int count);

/// Text between tags and in attributes. Characters that XML cannot hold become '?'.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace fathom::exchange
