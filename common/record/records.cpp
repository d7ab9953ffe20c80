#include "record/records.hpp"

#include <array>
#include <cstdio>

#include <zlib.h>

namespace fathom::record {

std::string to_string(Op op) {
  static constexpr std::array<const char*, 16> kNames{
      "",         "header",         "footer",         "schema",     "channel",          "message",
      "chunk",    "message index",  "chunk index",    "attachment", "attachment index", "statistics",
      "metadata", "metadata index", "summary offset", "data end"};
  const auto number = static_cast<std::size_t>(op);
  if (number >= 1 && number < kNames.size()) return kNames[number];
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "record 0x%02x", static_cast<unsigned>(number));
  return text.data();
}

std::uint32_t crc32(View bytes, std::uint32_t before) {
  uLong crc = before;
  while (!bytes.empty()) {  // zlib counts in unsigned int
    const auto part = bytes.first(std::min<std::size_t>(bytes.size(), 1U << 30U));
    crc = ::crc32(crc, part.data(), static_cast<uInt>(part.size()));
    bytes = bytes.subspan(part.size());
  }
  return static_cast<std::uint32_t>(crc);
}

}  // namespace fathom::record
