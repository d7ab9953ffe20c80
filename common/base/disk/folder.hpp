#pragma once

#include <filesystem>
#include <system_error>
#include <vector>

namespace fathom {

/// What lies in a folder, in no order, as far as it can be read; `failed` says why not all of it. A range-for
/// over the folder would throw where the disk gives up.
[[nodiscard]] inline std::vector<std::filesystem::path> paths_in(const std::filesystem::path& folder,
                                                                 std::error_code& failed) {
  std::vector<std::filesystem::path> out;
  std::filesystem::directory_iterator at(folder, failed);
  for (; !failed && at != std::filesystem::directory_iterator(); at.increment(failed))
    out.push_back(at->path());
  return out;
}

}  // namespace fathom
