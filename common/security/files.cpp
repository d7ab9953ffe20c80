#include "security/files.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fathom::security {
namespace {

constexpr off_t kLargest = 1 << 20;  // of a key, a certificate or a signed document

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

std::string errno_text() {
  return std::strerror(errno);
}

std::string read_file(const std::filesystem::path& file, bool is_private) {
  const Descriptor in(open(file.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat facts {};
  if (in.get() < 0 || fstat(in.get(), &facts) != 0) {
    throw SecurityError(file.string() + ": cannot be read (" + errno_text() +
                        "), expected a file as fathom keygen writes");
  }
  if (!S_ISREG(facts.st_mode) || facts.st_size > kLargest) {
    throw SecurityError(file.string() + ": is no file of at most 1 MB, expected one as fathom keygen writes");
  }
  if (is_private && (facts.st_mode & 077U) != 0) {
    char mode[8];
    std::snprintf(mode, sizeof mode, "%04o", facts.st_mode & 0777U);
    throw SecurityError(file.string() + ": is open to others than its owner (mode " + mode +
                        "), expected a private key of mode 0600");
  }
  std::string text(static_cast<std::size_t>(facts.st_size), '\0');
  std::size_t filled = 0;
  while (filled < text.size()) {
    const ssize_t got = read(in.get(), text.data() + filled, text.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw SecurityError(file.string() + ": cannot be read (" + errno_text() + ")");
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  text.resize(filled);
  return text;
}

void write_file(const std::filesystem::path& file, const std::string& text, mode_t mode) {
  const auto fail = [&](const char* expected) {
    throw WriteError(file.string() + ": cannot be written (" + errno_text() + "), expected " + expected);
  };
  const std::string beside = file.string() + ".new";
  unlink(beside.c_str());  // left by a run that was cut off
  {
    const Descriptor out(open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
    if (out.get() < 0) fail("a folder that may be written to");
    // Whatever the umask: what is public must be readable by the services' user.
    if (fchmod(out.get(), mode) != 0) fail("a file system with permissions");
    std::size_t written = 0;
    while (written < text.size()) {
      const ssize_t put = write(out.get(), text.data() + written, text.size() - written);
      if (put < 0 && errno == EINTR) continue;
      if (put < 0) fail("room on the disk");
      written += static_cast<std::size_t>(put);
    }
    if (fsync(out.get()) != 0) fail("a working disk");
  }
  if (rename(beside.c_str(), file.c_str()) != 0) fail("a folder that may be written to");
}

}  // namespace

std::string read_text(const std::filesystem::path& file) {
  return read_file(file, false);
}
std::string read_private(const std::filesystem::path& file) {
  return read_file(file, true);
}
void write_text(const std::filesystem::path& file, const std::string& text) {
  write_file(file, text, 0644);
}
void write_private(const std::filesystem::path& file, const std::string& text) {
  write_file(file, text, 0600);
}

}  // namespace fathom::security
