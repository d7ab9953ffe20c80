#pragma once

#include <string>
#include <vector>

#include "record/reader.hpp"

namespace fathom::cli {

/// Opens a recording; one that was not closed is said on standard error and read as far as it goes. Throws
/// Failure.
[[nodiscard]] record::Reader open_recording(const std::string& file);

/// Topics by their full or their short names, e.g. "nav_state". Throws Failure for one that there is not.
[[nodiscard]] std::vector<std::string> topics_of(const std::vector<std::string>& words);

}  // namespace fathom::cli
