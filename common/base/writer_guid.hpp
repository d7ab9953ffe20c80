#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace fathom {

/// Identity of a writer on the vehicle network, DDS GUID: 12 bytes of its process, 4 of itself.
using WriterGuid = std::array<std::uint8_t, 16>;

/// A writer that is followed by another one of its process is no other writer.
[[nodiscard]] inline bool of_same_process(const WriterGuid& a, const WriterGuid& b) {
  constexpr std::size_t kProcessBytes = 12;
  return std::equal(a.begin(), a.begin() + kProcessBytes, b.begin());
}

}  // namespace fathom
