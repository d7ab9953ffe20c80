#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <termios.h>

#include "simulator/device_link.hpp"
#include "simulator/file_descriptor.hpp"

namespace fathom::simulator {
namespace {

namespace fs = std::filesystem;

LinkError trouble(const std::string& what, const std::string& path) {
  return LinkError(path + ": " + what + ": " + std::strerror(errno));
}

class PtyLink final : public DeviceLink {
 public:
  PtyLink(std::string link_path, const Clock& clock) : link_path_(std::move(link_path)), clock_(clock) {
    master_ = FileDescriptor(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    if (!master_.valid() || ::grantpt(master_.get()) != 0 || ::unlockpt(master_.get()) != 0) {
      throw trouble("no pseudo-terminal to be had", link_path_);
    }
    std::array<char, 128> name{};
    if (::ptsname_r(master_.get(), name.data(), name.size()) != 0) {
      throw trouble("no name for the pseudo-terminal", link_path_);
    }
    device_ = name.data();
    // Held open, so that the terminal keeps its mode and the master does not fail while nobody reads.
    slave_ = FileDescriptor(::open(device_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    termios mode{};
    if (!slave_.valid() || ::tcgetattr(slave_.get(), &mode) != 0)
      throw trouble("cannot open " + device_, link_path_);
    ::cfmakeraw(&mode);
    if (::tcsetattr(slave_.get(), TCSANOW, &mode) != 0)
      throw trouble("no raw mode on " + device_, link_path_);
    place_link();
    last_drained_ns_ = clock_.monotonic_ns();
  }

  ~PtyLink() override {
    std::error_code error;
    if (fs::read_symlink(link_path_, error) == device_) fs::remove(link_path_, error);
  }
  PtyLink(const PtyLink&) = delete;
  PtyLink& operator=(const PtyLink&) = delete;

  void send(std::span<const std::uint8_t> bytes) override {
    discard_input();
    const TimeNs now = clock_.monotonic_ns();
    int waiting = 0;
    if (::ioctl(slave_.get(), FIONREAD, &waiting) != 0) waiting = 0;
    if (waiting == 0) last_drained_ns_ = now;
    if (to_seconds(now - last_drained_ns_) > kStale_s * clock_.rate()) {
      ::tcflush(slave_.get(), TCIFLUSH);
      counters_.bytes_dropped += static_cast<std::uint64_t>(waiting);
      counters_.bytes_sent -= std::min(counters_.bytes_sent, static_cast<std::uint64_t>(waiting));
      last_drained_ns_ = now;
      waiting = 0;
    }
    if (static_cast<std::size_t>(waiting) + bytes.size() > kMostWaiting) {  // whole messages or none
      counters_.bytes_dropped += bytes.size();
      return;
    }
    const ssize_t written = ::write(master_.get(), bytes.data(), bytes.size());
    const auto done = static_cast<std::uint64_t>(written > 0 ? written : 0);
    counters_.bytes_sent += done;
    counters_.bytes_dropped += bytes.size() - done;
  }

  [[nodiscard]] LinkCounters counters() const override { return counters_; }
  [[nodiscard]] std::string where() const override { return link_path_ + " -> " + device_; }

 private:
  static constexpr double kStale_s = 0.5;
  // The kernel holds 4095 bytes for the reader.
  static constexpr std::size_t kMostWaiting = 3500;

  void place_link() {
    const fs::path link(link_path_);
    std::error_code error;
    if (link.has_parent_path()) fs::create_directories(link.parent_path(), error);
    const auto status = fs::symlink_status(link, error);
    if (fs::exists(status) && !fs::is_symlink(status)) {
      throw LinkError(link_path_ + ": is a file, expected nothing or an old link");
    }
    // Renaming puts the new link in place at once, whatever a simulator that was killed left behind.
    const fs::path temporary = link_path_ + ".new";
    fs::remove(temporary, error);
    fs::create_symlink(device_, temporary, error);
    if (!error) fs::rename(temporary, link, error);
    if (error) throw LinkError(link_path_ + ": cannot be created: " + error.message());
  }

  // What readers send to the device (commands) is not understood and must not fill up.
  void discard_input() const {
    std::array<char, 256> ignored{};
    while (::read(master_.get(), ignored.data(), ignored.size()) > 0) {
    }
  }

  std::string link_path_;
  const Clock& clock_;
  std::string device_;
  FileDescriptor master_;
  FileDescriptor slave_;
  TimeNs last_drained_ns_ = 0;
  LinkCounters counters_{0, 0, 1};
};

}  // namespace

std::unique_ptr<DeviceLink> make_pty_link(const std::string& link_path, const Clock& clock) {
  return std::make_unique<PtyLink>(link_path, clock);
}

}  // namespace fathom::simulator
