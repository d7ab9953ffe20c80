#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fathom::archive {

/// Tells an archive from others: CRC-32 and Adler-32 of its bytes.
[[nodiscard]] std::uint64_t digest(std::span<const std::byte> archive);

}  // namespace fathom::archive
