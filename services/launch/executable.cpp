#include "launch/executable.hpp"

#include <algorithm>

namespace fathom::launch {

std::filesystem::path executables_folder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

std::string executable_of(const std::string& service) {
  std::string out = "fathom-" + service;
  std::replace(out.begin(), out.end(), '_', '-');
  return out;
}

}  // namespace fathom::launch
