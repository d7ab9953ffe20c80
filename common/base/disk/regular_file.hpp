#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "base/result.hpp"

namespace fathom {

/// What is wrong with a path where a regular file is expected, to stand behind its name: "is a pipe, expected
/// a regular file". Empty where there is one. To be asked before the path is opened: a pipe makes who opens
/// it wait for a writer, and a device may be read without end.
[[nodiscard]] std::string no_regular_file(const std::filesystem::path& path);

/// All of a regular file of at most `most_bytes`; else what is wrong, to stand behind its name.
[[nodiscard]] Result<std::string> read_regular_file(const std::filesystem::path& path,
                                                    std::size_t most_bytes);

}  // namespace fathom
