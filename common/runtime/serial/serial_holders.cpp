#include "runtime/serial/serial_holders.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>

#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

namespace fathom::runtime {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kFirstPtyMajor = 136;
constexpr unsigned kLastPtyMajor = 143;
constexpr const char* kUnseen = "another process";

bool is_pseudo_terminal(dev_t device) {
  return major(device) >= kFirstPtyMajor && major(device) <= kLastPtyMajor;
}

/// The number of the pseudo-terminal that this descriptor is the device side of.
std::optional<unsigned> made_by(const fs::path& descriptor_info) {
  std::ifstream in(descriptor_info);
  for (std::string word; in >> word;) {
    unsigned number = 0;
    if (word == "tty-index:" && in >> number) return number;
  }
  return std::nullopt;
}

/// The same line, also where a container has a node of its own for it.
bool same_line(const struct stat& one, const struct stat& other) {
  return S_ISCHR(other.st_mode) && one.st_rdev == other.st_rdev &&
         (!is_pseudo_terminal(one.st_rdev) || one.st_dev == other.st_dev);
}

bool holds(const fs::path& process, const struct stat& line) {
  bool open = false;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(process / "fd", error)) {
    struct stat other {};
    if (stat(entry.path().c_str(), &other) != 0 || !S_ISCHR(other.st_mode)) continue;
    open = open || same_line(line, other);
    if (is_pseudo_terminal(line.st_rdev) &&
        made_by(process / "fdinfo" / entry.path().filename()) == minor(line.st_rdev))
      return false;
  }
  return open;
}

std::string name_of(const fs::path& process) {
  std::ifstream in(process / "cmdline", std::ios::binary);
  std::string program;
  std::getline(in, program, '\0');
  program = fs::path(program).filename().string();
  return "process " + process.filename().string() + (program.empty() ? "" : " (" + program + ")");
}

std::string name_of_user(uid_t user) {
  const passwd* entry = getpwuid(user);
  return entry != nullptr ? entry->pw_name : std::to_string(user);
}

std::string name_of_group(gid_t group) {
  const ::group* entry = getgrgid(group);
  return entry != nullptr ? entry->gr_name : std::to_string(group);
}

/// Whose the device is, and who else may use it.
std::string rights_of(const struct stat& status) {
  constexpr mode_t kGroupMay = S_IRGRP | S_IWGRP;
  std::array<char, 8> mode{};
  std::snprintf(mode.data(), mode.size(), "%04o", static_cast<unsigned>(status.st_mode & 07777U));
  const std::string owner = name_of_user(status.st_uid);
  const std::string group = name_of_group(status.st_gid);
  if ((status.st_mode & kGroupMay) != kGroupMay)
    return "its mode " + std::string(mode.data()) + " lets only " + owner +
           " read and write it, expected 0660 and a group that this user is in, e.g. dialout";
  return "it is for " + owner + " and the group " + group + ", and " + name_of_user(geteuid()) +
         " is not in that; sudo usermod -a -G " + group + " " + name_of_user(geteuid()) +
         " and a new login help";
}

}  // namespace

std::string serial_holders(const std::string& path) {
  struct stat line {};
  if (stat(path.c_str(), &line) != 0 || !S_ISCHR(line.st_mode)) return "";
  const std::string own = std::to_string(getpid());
  std::string out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc", error)) {
    const std::string number = entry.path().filename().string();
    const bool is_process =
        std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (is_process && number != own && holds(entry.path(), line))
      out += (out.empty() ? "" : ", ") + name_of(entry.path());
  }
  return out;
}

std::string serial_occupant(const std::string& path) {
  std::string seen = serial_holders(path);
  if (!seen.empty()) return seen;
  struct stat line {};
  if (stat(path.c_str(), &line) != 0 || !S_ISCHR(line.st_mode)) return "";
  const int descriptor = open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return errno == EBUSY ? kUnseen : "";
  const bool locked = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return locked ? kUnseen : "";
}

SerialClaim::SerialClaim(int descriptor, const std::string& path) {
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    const std::string holders = serial_holders(path);
    throw std::runtime_error("is in use by " + (holders.empty() ? std::string(kUnseen) : holders));
  }
  struct stat line {};
  if (fstat(descriptor, &line) == 0 && !is_pseudo_terminal(line.st_rdev) && ioctl(descriptor, TIOCEXCL) == 0)
    exclusive_ = descriptor;
}

SerialClaim::~SerialClaim() {
  release();
}

void SerialClaim::release() {
  if (exclusive_ >= 0) ioctl(exclusive_, TIOCNXCL);
  exclusive_ = -1;
}

std::string serial_trouble(const std::string& path, const std::error_code& error) {
  const std::string said = error.message();
  if (error.value() == ENOTTY) return "is no serial port (" + said + ")";
  if (error.value() == EBUSY) {
    const std::string holders = serial_holders(path);
    return said + ": it is in use by " + (holders.empty() ? std::string(kUnseen) : holders);
  }
  struct stat status {};
  if (error.value() != EACCES || stat(path.c_str(), &status) != 0) return said;
  return said + ": " + rights_of(status);
}

}  // namespace fathom::runtime
