#include "host/deafness.hpp"

#include <array>
#include <charconv>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include "base/disk/folder.hpp"

namespace fathom::host {
namespace {

constexpr std::uint32_t kPortBase = 7400;
constexpr std::uint32_t kPortsOfADomain = 250;
constexpr DurationNs kPatienceNs = 10 * kNsPerSecond;
constexpr DurationNs kPeriodNs = kNsPerSecond;
/// Less may be a stray datagram to a socket that only sends.
constexpr std::uint32_t kLeastBytes = 64 * 1024;

/// The port that a UDP socket is bound to; none for anything else.
std::optional<std::uint32_t> udp_port(int fd) {
  int type = 0;
  socklen_t size = sizeof type;
  if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) return {};
  sockaddr_in address{};
  size = sizeof address;
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0 || address.sin_family != AF_INET)
    return {};
  return ntohs(address.sin_port);
}

/// What waits in a socket, as its memory counts it.
std::uint32_t waiting_bytes(int fd) {
  std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
  socklen_t size = sizeof memory;
  if (getsockopt(fd, SOL_SOCKET, SO_MEMINFO, memory.data(), &size) != 0) return 0;
  return memory[SK_MEMINFO_RMEM_ALLOC];
}

/// A hash of the datagram that is read next, which stays where it is. RTPS datagrams have counts and instants
/// in them: two of them do not begin alike.
std::size_t first_of(int fd) {
  std::array<char, 512> begin{};
  const ssize_t size = recv(fd, begin.data(), begin.size(), MSG_PEEK | MSG_DONTWAIT);
  return size <= 0 ? 0 : std::hash<std::string_view>()({begin.data(), static_cast<std::size_t>(size)});
}

}  // namespace

Deafness::Deafness(std::uint32_t domain) : first_port_(kPortBase + kPortsOfADomain * domain) {}

bool Deafness::look(TimeNs monotonic_ns) {
  if (looked_ns_ != 0 && monotonic_ns - looked_ns_ < kPeriodNs) return false;
  looked_ns_ = monotonic_ns;
  bool deaf = false;
  for (auto& [inode, waiting] : sockets_) waiting.seen = false;
  std::error_code error;
  for (const std::filesystem::path& descriptor : paths_in("/proc/self/fd", error)) {
    const std::string name = descriptor.filename().string();
    int fd = -1;
    if (std::from_chars(name.data(), name.data() + name.size(), fd).ec != std::errc{}) continue;
    const auto port = udp_port(fd);
    struct stat about {};
    if (!port || *port < first_port_ || *port >= first_port_ + kPortsOfADomain || fstat(fd, &about) != 0)
      continue;
    Waiting& waiting = sockets_[about.st_ino];
    const std::size_t first = waiting_bytes(fd) < kLeastBytes ? 0 : first_of(fd);
    if (first == 0 || first != waiting.first) waiting.since_ns = monotonic_ns;
    waiting.first = first;
    waiting.seen = true;
    deaf = deaf || monotonic_ns - waiting.since_ns >= kPatienceNs;
  }
  std::erase_if(sockets_, [](const auto& one) { return !one.second.seen; });
  return deaf;
}

}  // namespace fathom::host
