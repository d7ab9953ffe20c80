#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "logs/series.hpp"

/// PX4's ULog, after its specification (docs.px4.io, ULog File Format), versions 0 and later.
namespace fathom::logs::ulog {

/// True where the file begins as a ULog file does.
[[nodiscard]] bool looks_like(const std::filesystem::path& path);

/// Reads a whole file: definitions, data and appended data. `wanted` names the topics whose messages are
/// kept; of the others only the number is. Damage is passed over to the next sound message and stands in
/// `losses`; an unfinished message at the end of a section is dropped. Throws LogError where nothing can be
/// read: no such file, no ULog header, a feature that this reader does not know.
[[nodiscard]] Log read(const std::filesystem::path& path, const std::set<std::string>& wanted);

}  // namespace fathom::logs::ulog
