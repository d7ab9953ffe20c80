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
/// and off those of the DDS domains of the tests: nobody takes it before the caller does. Tests that run side
/// by side begin at different places. `type`: SOCK_STREAM or SOCK_DGRAM.
[[nodiscard]] inline int free_port(int type) {
  constexpr int kFirst = 20'000;
  constexpr int kPorts = 8'000;
  static std::atomic<int> next = static_cast<int>(getpid()) % 400 * 20;
  for (int tried = 0; tried < kPorts; ++tried) {
    const int port = kFirst + next++ % kPorts;
    const int probe = socket(AF_INET, type, 0);
    const sockaddr_in address = loopback(port);
    const bool free = bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    close(probe);
    if (free) return port;
  }
  throw std::runtime_error("no free port");
}

}  // namespace fathom::test
