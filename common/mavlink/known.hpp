#pragma once

#include <cstdint>

namespace fathom::mavlink {

/// A message of the published dialects.
struct Known {
  std::uint32_t id = 0;
  std::uint8_t crc_extra = 0;
  std::uint8_t longest = 0;  ///< payload with all extensions
};

/// Null for one that is not among them.
[[nodiscard]] const Known* find_known(std::uint32_t id);

}  // namespace fathom::mavlink
