#include "host/deafness.hpp"

#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <system_error>

#include <sys/stat.h>

namespace fathom::host {
namespace {

constexpr std::uint32_t kPortBase = 7400;
constexpr std::uint32_t kPortsOfADomain = 250;
constexpr DurationNs kPatienceNs = 10 * kNsPerSecond;
constexpr DurationNs kPeriodNs = kNsPerSecond;
/// Less may be a stray datagram to a socket that only sends.
constexpr std::uint32_t kLeastBytes = 64 * 1024;

/// Inodes of the sockets of this process.
std::set<std::uint64_t> own_sockets() {
  std::set<std::uint64_t> inodes;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string name = entry.path().filename().string();
    int fd = -1;
    struct stat about {};
    if (std::from_chars(name.data(), name.data() + name.size(), fd).ec == std::errc{} &&
        fstat(fd, &about) == 0 && S_ISSOCK(about.st_mode))
      inodes.insert(about.st_ino);
  }
  return inodes;
}

/// A line of /proc/net/udp (proc(5)): hexadecimal but for the inode.
struct UdpLine {
  std::uint32_t port = 0;
  std::uint32_t waiting_bytes = 0;
  std::uint64_t inode = 0;
};
bool parse(const std::string& line, UdpLine& out) {
  return std::sscanf(line.c_str(),
                     " %*u: %*[0-9A-Fa-f]:%x %*[0-9A-Fa-f:] %*x %*x:%x %*x:%*x %*x %*u %*u %" SCNu64,
                     &out.port, &out.waiting_bytes, &out.inode) == 3;
}

}  // namespace

Deafness::Deafness(std::uint32_t domain) : first_port_(kPortBase + kPortsOfADomain * domain) {}

bool Deafness::look(TimeNs monotonic_ns) {
  if (looked_ns_ != 0 && monotonic_ns - looked_ns_ < kPeriodNs) return false;
  looked_ns_ = monotonic_ns;
  bool deaf = false;
  for (auto& [inode, waiting] : sockets_) waiting.seen = false;
  const std::set<std::uint64_t> own = own_sockets();
  std::ifstream file("/proc/self/net/udp");
  std::string line;
  for (UdpLine udp; std::getline(file, line);) {
    if (!parse(line, udp) || udp.port < first_port_ || udp.port >= first_port_ + kPortsOfADomain ||
        !own.contains(udp.inode))
      continue;
    Waiting& waiting = sockets_[udp.inode];
    if (udp.waiting_bytes < kLeastBytes || udp.waiting_bytes < waiting.bytes || waiting.since_ns == 0)
      waiting.since_ns = monotonic_ns;
    waiting.bytes = udp.waiting_bytes;
    waiting.seen = true;
    deaf = deaf || monotonic_ns - waiting.since_ns >= kPatienceNs;
  }
  std::erase_if(sockets_, [](const auto& one) { return !one.second.seen; });
  return deaf;
}

}  // namespace fathom::host
