#include "logs/file_window.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "logs/series.hpp"

namespace fathom::logs {
namespace {

constexpr std::size_t kWindow = std::size_t{1} << 20U;

}  // namespace

FileWindow::FileWindow(const std::filesystem::path& path) : name_(path.string()) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw LogError(name_ + ": is not a file, expected a flight log");
  size_ = std::filesystem::file_size(path, error);
  if (error) throw LogError(name_ + ": cannot be read: " + error.message());
  file_.open(path, std::ios::binary);
  if (!file_) throw LogError(name_ + ": cannot be read: " + std::strerror(errno));
}

std::span<const std::uint8_t> FileWindow::at(std::uint64_t offset, std::size_t length) {
  if (offset >= size_) return {};
  length = static_cast<std::size_t>(std::min<std::uint64_t>(length, size_ - offset));
  if (offset < begin_ || offset + length > begin_ + window_.size()) {
    const std::uint64_t wanted = std::min<std::uint64_t>(std::max(length, kWindow), size_ - offset);
    window_.resize(static_cast<std::size_t>(wanted));
    begin_ = offset;
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(offset));
    file_.read(reinterpret_cast<char*>(window_.data()), static_cast<std::streamsize>(wanted));
    if (static_cast<std::uint64_t>(file_.gcount()) != wanted) {
      throw LogError(name_ + ": offset " + std::to_string(offset) + ": " + std::to_string(file_.gcount()) +
                     " bytes could be read, expected " + std::to_string(wanted));
    }
  }
  return {window_.data() + (offset - begin_), length};
}

}  // namespace fathom::logs
