#include "cli/removed_files.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "base/disk/folder.hpp"

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const char* part : {"", "sources"}) {  // where data sets of logs keep all that was logged
    std::error_code error;
    for (const fs::path& file : paths_in(folder / part, error)) {
      if (!fs::is_directory(fs::symlink_status(file, error))) out.push_back(fs::path(part) / file.filename());
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

RemovedFiles::RemovedFiles(fs::path folder) : folder_(std::move(folder)), before_(files_in(folder_)) {}

RemovedFiles::~RemovedFiles() {
  constexpr std::size_t kNamed = 12;
  std::string names;
  std::size_t removed = 0;
  for (const fs::path& file : before_) {
    std::error_code error;
    if (fs::exists(fs::symlink_status(folder_ / file, error))) continue;
    if (++removed <= kNamed) names += (names.empty() ? "" : ", ") + file.string();
  }
  if (removed == 0) return;
  if (removed > kNamed) names += " and " + std::to_string(removed - kNamed) + " more";
  std::fprintf(stderr,
               "fathom: %s: %s: removed, a data set is the whole folder and the new one has no such file\n",
               folder_.c_str(), names.c_str());
}

}  // namespace fathom::cli
