#pragma once

#include <string>
#include <vector>

#include "base/exit_code.hpp"

namespace fathom::cli {

/// Proves that the navigation states and verdicts in a recording, of one file or of several that follow one
/// another, follow from the samples and orders in it:
/// the engine, configured as it was, is given them in the order in which fusion took them, and what it says
/// is compared bit for bit. Prints a line for each run of a fusion service: equal, or the first difference.
/// `no` when one differs or cannot be proved. Throws Failure.
[[nodiscard]] ExitCode verify(const std::vector<std::string>& files);

}  // namespace fathom::cli
