#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace fathom::fusion {

/// Reads the whole file. The error says why it cannot be read.
[[nodiscard]] Result<std::vector<std::byte>> read_file(const std::filesystem::path& path);

/// Writes a new file beside `path` and renames it, so that readers find either the old file or the new one.
/// With `sync` the file is on the disk when this returns. Missing folders are made. Returns why it failed, or
/// nothing.
[[nodiscard]] std::string replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes,
                                       bool sync);

}  // namespace fathom::fusion
