#include "runtime/clock_anchor.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace fathom::runtime {
namespace {

int lock(int descriptor, int how) {
  int result = 0;
  do {
    result = ::flock(descriptor, how);
  } while (result != 0 && errno == EINTR);
  return result;
}

}  // namespace

ClockAnchor::ClockAnchor(const std::string& file, const Clock& host)
    : offset_ns_(host.utc_ns() - host.monotonic_ns()) {
  if (!file.empty()) join(file);
  if (!trouble_.empty() && descriptor_ >= 0) {
    ::close(descriptor_);
    descriptor_ = -1;
  }
}

void ClockAnchor::join(const std::string& file) {
  const auto failed = [&](const char* what) { trouble_ = file + " " + what + ": " + std::strerror(errno); };
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640);
  if (descriptor_ < 0) return failed("cannot be opened");
  if (lock(descriptor_, LOCK_EX | LOCK_NB) == 0) {
    const std::string text = std::to_string(offset_ns_) + "\n";
    if (::ftruncate(descriptor_, 0) != 0 ||
        ::pwrite(descriptor_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
      return failed("cannot be written");
    }
  }
  // Between the two locks another service may have written: what counts is what stands there under this one.
  if (lock(descriptor_, LOCK_SH) != 0) return failed("cannot be locked");
  std::array<char, 32> text{};
  const ssize_t size = ::pread(descriptor_, text.data(), text.size(), 0);
  if (size < 0) return failed("cannot be read");
  DurationNs shared_ns = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + size, shared_ns);
  if (parsed.ec != std::errc() || parsed.ptr == text.data() + size || *parsed.ptr != '\n') {
    trouble_ = file + " holds no clock anchor, expected nanoseconds as one line of digits";
    return;
  }
  offset_ns_ = shared_ns;
}

ClockAnchor::~ClockAnchor() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace fathom::runtime
