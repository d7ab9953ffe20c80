#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/result.hpp"
#include "record/walk.hpp"

namespace fathom::record {

/// What became of a file that was not closed.
struct Recovery {
  bool was_whole = false;      ///< nothing had to be done
  std::uint64_t messages = 0;  ///< that can be read
  std::uint64_t cut = 0;       ///< bytes behind the last whole record
  std::string ending;          ///< how the file ended, in words
  std::filesystem::path rest;  ///< where these bytes were put, when they were many; else empty
};

/// Closes a file in its place: what stands behind the last whole record is cut off, message indexes that are
/// missing, summary and footer are written. More than `kept_rest` bytes are put into PATH.rest first, for
/// they may be more than a last chunk. Messages stay as they are to the bit.
[[nodiscard]] Result<Recovery> recover(const std::filesystem::path& path, const Limits& limits = {},
                                       std::uint64_t kept_rest = 4U << 20U);

}  // namespace fathom::record
