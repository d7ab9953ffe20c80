#include "record/file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fathom::record {
namespace {

std::string reason() {
  return std::generic_category().message(errno);
}
Error because(const std::filesystem::path& path, const std::string& what) {
  return {path.string() + ": " + what + ": " + reason()};
}

}  // namespace

Result<std::unique_ptr<FileSink>> FileSink::create(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0640);
  if (descriptor < 0) return because(path, "cannot be created");
  (void)::flock(descriptor, LOCK_EX | LOCK_NB);  // for go_on() of others; some file systems have none
  return std::unique_ptr<FileSink>(new FileSink(descriptor, 0));
}

Result<std::unique_ptr<FileSink>> FileSink::go_on(const std::filesystem::path& path, std::uint64_t size) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) return because(path, "cannot be written");
  std::unique_ptr<FileSink> sink(new FileSink(descriptor, size));
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    return Error{path.string() + ": somebody is writing it now"};
  }
  if (::ftruncate(descriptor, static_cast<off_t>(size)) != 0) return because(path, "cannot be cut");
  if (::lseek(descriptor, static_cast<off_t>(size), SEEK_SET) < 0) return because(path, "cannot be written");
  return sink;
}

FileSink::~FileSink() {
  ::close(descriptor_);
}

std::string FileSink::append(View bytes) {
  const auto back = [this] {
    torn_ = ::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0 ||
            ::lseek(descriptor_, static_cast<off_t>(size_), SEEK_SET) < 0;
  };
  if (torn_) back();
  if (torn_) return "what a failed write left cannot be cut off: " + reason();
  View left = bytes;
  while (!left.empty()) {
    const ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      std::string why = written == 0 ? "nothing was written" : reason();
      back();
      return why;
    }
    left = left.subspan(static_cast<std::size_t>(written));
  }
  size_ += bytes.size();
  return {};
}

std::string FileSink::sync() {
  return ::fdatasync(descriptor_) == 0 ? std::string() : reason();
}

bool FileSink::is_removed() const {
  struct stat status {};
  return ::fstat(descriptor_, &status) == 0 && status.st_nlink == 0;
}

bool FileSink::is_at(const std::filesystem::path& path) const {
  struct stat own {};
  struct stat there {};
  return ::fstat(descriptor_, &own) == 0 && ::stat(path.c_str(), &there) == 0 && own.st_dev == there.st_dev &&
         own.st_ino == there.st_ino;
}

Result<std::unique_ptr<FileSource>> FileSource::open(const std::filesystem::path& path) {
  // A pipe is not waited for.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return because(path, "cannot be opened");
  std::unique_ptr<FileSource> source(new FileSource(descriptor, 0));
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return because(path, "cannot be looked at");
  if (!S_ISREG(status.st_mode)) return Error{path.string() + ": is no file, expected a recording"};
  source->size_ = static_cast<std::uint64_t>(status.st_size);
  return source;
}

FileSource::~FileSource() {
  ::close(descriptor_);
}

std::string FileSource::read(std::uint64_t offset, std::span<std::uint8_t> into) {
  while (!into.empty()) {
    const ssize_t got = ::pread(descriptor_, into.data(), into.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return reason();
    if (got == 0) return "the file became shorter while it was read";
    into = into.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
  return {};
}

std::string MemorySource::read(std::uint64_t offset, std::span<std::uint8_t> into) {
  std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), into.size(), into.begin());
  return {};
}

}  // namespace fathom::record
