#pragma once

#include <filesystem>
#include <vector>

#include "live/doctor/checks.hpp"

namespace fathom::cli {

/// Looks at this host. What cannot be found out stays unknown.
[[nodiscard]] HostFacts look_at_host();

/// Files of Fast DDS in `shared_memory` that no process has mapped or open, and that were not made within the
/// last seconds. Processes are those in `processes` (/proc); a file of a user whose processes cannot be
/// looked at is left out.
[[nodiscard]] std::vector<ShmLeftover> find_leftovers(const std::filesystem::path& shared_memory,
                                                      const std::filesystem::path& processes);

/// Removes them. Returns those that could not be.
[[nodiscard]] std::vector<ShmLeftover> remove_leftovers(const std::vector<ShmLeftover>& leftovers);

}  // namespace fathom::cli
