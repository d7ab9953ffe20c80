#pragma once

#include <filesystem>
#include <vector>

namespace fathom::cli {

/// Says at its end, in one line on standard error, which files were in a folder when it began and are there
/// no more: a data set that is written takes away what an earlier one left.
class RemovedFiles {
 public:
  explicit RemovedFiles(std::filesystem::path folder);
  ~RemovedFiles();
  RemovedFiles(const RemovedFiles&) = delete;
  RemovedFiles& operator=(const RemovedFiles&) = delete;

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> before_;  ///< relative to it
};

}  // namespace fathom::cli
