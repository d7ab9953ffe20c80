#include <cerrno>
#include <cstring>
#include <fstream>

#include "cli/command.hpp"

namespace fathom::cli {

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw Failure(ExitCode::runtime_failure, path + ": cannot be written: " + std::strerror(errno));
}

}  // namespace fathom::cli
