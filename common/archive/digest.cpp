#include "archive/digest.hpp"

#include <zlib.h>

namespace fathom::archive {

std::uint64_t digest(std::span<const std::byte> archive) {
  const auto* data = reinterpret_cast<const Bytef*>(archive.data());
  const std::uint64_t crc = crc32_z(crc32_z(0, nullptr, 0), data, archive.size());
  const std::uint64_t adler = adler32_z(adler32_z(0, nullptr, 0), data, archive.size());
  return crc << 32U | adler;
}

}  // namespace fathom::archive
