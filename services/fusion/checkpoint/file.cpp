#include "fusion/checkpoint/file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fcntl.h>
#include <unistd.h>

namespace fathom::fusion {
namespace {

std::string failure(const std::string& what, const std::filesystem::path& path) {
  return path.string() + ": " + what + ": " + std::strerror(errno);
}

bool write_all(int file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return Error{"is not there"};
  if (!std::filesystem::is_regular_file(path, error)) return Error{"is no regular file"};
  // Far more than any engine holds, so that another large file is not read into memory.
  constexpr std::uintmax_t kMost = 256U << 20U;
  if (std::filesystem::file_size(path, error) > kMost || error) return Error{"is no checkpoint: too large"};
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> all{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file && !file.eof()) return Error{"cannot be read"};
  const auto bytes = std::as_bytes(std::span(all));
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

std::string replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes, bool sync) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::filesystem::path beside = path;
  beside += ".new";
  // A pipe that lies there is not waited for.
  const int file = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0600);
  if (file < 0) return failure("cannot be written", beside);
  const bool written = write_all(file, bytes) && (!sync || ::fsync(file) == 0);
  std::string why = written ? std::string() : failure("cannot be written", beside);
  if (::close(file) != 0 && why.empty()) why = failure("cannot be written", beside);
  if (why.empty() && ::rename(beside.c_str(), path.c_str()) != 0) why = failure("cannot be replaced", path);
  if (!why.empty()) {
    ::unlink(beside.c_str());
    return why;
  }
  if (!sync) return {};
  const int place = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (place < 0) return failure("cannot be synchronised", folder);
  const bool synced = ::fsync(place) == 0;
  why = synced ? std::string() : failure("cannot be synchronised", folder);
  ::close(place);
  return why;
}

}  // namespace fathom::fusion
