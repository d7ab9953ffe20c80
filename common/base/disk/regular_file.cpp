#include "base/disk/regular_file.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>

#include <sys/stat.h>

namespace fathom {
namespace {

std::string unreadable() {
  return "cannot be read: " + std::generic_category().message(errno) + ", expected a regular file";
}

std::string words(std::size_t bytes) {
  constexpr std::size_t kKiB = 1024;
  if (bytes % (kKiB * kKiB) == 0) return std::to_string(bytes / (kKiB * kKiB)) + " MiB";
  if (bytes % kKiB == 0) return std::to_string(bytes / kKiB) + " KiB";
  return std::to_string(bytes) + " bytes";
}

}  // namespace

std::string no_regular_file(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return unreadable();
  if (S_ISREG(status.st_mode)) return {};
  const char* kind = S_ISDIR(status.st_mode)                              ? "a folder"
                     : S_ISFIFO(status.st_mode)                           ? "a pipe"
                     : S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode) ? "a device"
                                                                          : "a socket";
  return std::string("is ") + kind + ", expected a regular file";
}

Result<std::string> read_regular_file(const std::filesystem::path& path, std::size_t most_bytes) {
  if (std::string wrong = no_regular_file(path); !wrong.empty()) return Error{std::move(wrong)};
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{unreadable()};
  std::string text;
  constexpr std::size_t kPiece = 64 * 1024;
  while (file && text.size() <= most_bytes) {
    const std::size_t before = text.size();
    text.resize(before + kPiece);
    file.read(text.data() + before, kPiece);
    text.resize(before + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) return Error{unreadable()};
  if (text.size() > most_bytes) return Error{"is larger, expected at most " + words(most_bytes)};
  return text;
}

}  // namespace fathom
