#pragma once

#include <string_view>

namespace fathom::fuzz {

/// The protocol that this fuzz target feeds: the driver takes its seed stream from there.
[[nodiscard]] std::string_view target_protocol();

}  // namespace fathom::fuzz
