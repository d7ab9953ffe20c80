#pragma once

#include <atomic>
#include <cstdint>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace fathom::test {

/// Of a port of this host.
[[nodiscard]] inline sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

/// A port of this host that nobody had a moment ago. It lies below those that the system hands out unasked
/// and off those of DDS, whose participants knock at each other's ports whether anybody is there or not: of
/// the 250 ports of a domain 94 participants use the first 200. Tests that run side by side begin at
/// different places. `type`: SOCK_STREAM or SOCK_DGRAM.
[[nodiscard]] inline int free_port(int type) {
  constexpr int kOfADomain = 250;
  constexpr int kFree = 50;
  constexpr int kFirst = 7'400 + 50 * kOfADomain + kOfADomain - kFree;  // of domain 50
  constexpr int kPorts = 32 * kFree;
  static std::atomic<int> next = static_cast<int>(getpid()) % 80 * 20;
  for (int tried = 0; tried < kPorts; ++tried) {
    const int place = next++ % kPorts;
    const int port = kFirst + place / kFree * kOfADomain + place % kFree;
    const int probe = socket(AF_INET, type, 0);
    const sockaddr_in address = loopback(port);
    const bool free = bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    close(probe);
    if (free) return port;
  }
  throw std::runtime_error("no free port");
}

}  // namespace fathom::test
