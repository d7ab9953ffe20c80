#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace fathom::fuzz {

/// What this fuzz target feeds, e.g. a protocol.
[[nodiscard]] std::string_view target_name();

/// Bytes of the kind that it usually gets, from which mutations start.
[[nodiscard]] std::vector<std::uint8_t> target_seed();

}  // namespace fathom::fuzz
