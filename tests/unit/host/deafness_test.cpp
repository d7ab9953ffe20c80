#include "host/deafness.hpp"

#include <array>
#include <cstdint>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/failing_readdir.hpp"

namespace fathom::host {
namespace {

constexpr std::uint32_t kDomain = 99;
constexpr std::uint16_t kPort = 7400 + 250 * kDomain + 211;  // of participants that nobody has
constexpr TimeNs kBegin = 1000 * kNsPerSecond;

/// A socket of this process, and what is sent to it.
class Socket {
 public:
  explicit Socket(std::uint16_t port) : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to_.sin_port = htons(port);
    const int room = 4 << 20;
    setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
    if (bind(fd_, reinterpret_cast<const sockaddr*>(&to_), sizeof to_) != 0) ADD_FAILURE() << "port " << port;
  }
  ~Socket() { close(fd_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  void send(int datagrams) {
    for (int i = 0; i < datagrams; ++i) {
      ++data_[0];  // each another one
      sendto(fd_, data_.data(), data_.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
    }
  }
  void take(int datagrams) {
    std::array<char, 4000> taken{};
    for (int i = 0; i < datagrams; ++i) (void)recv(fd_, taken.data(), taken.size(), 0);
  }

 private:
  int fd_;
  sockaddr_in to_{};
  std::array<char, 4000> data_{};
};

/// Whether it is deaf within so many looks, one a second, with `between` after each.
template <class Between>
bool deaf_within(Deafness& deafness, int looks, Between&& between) {
  for (int i = 0; i < looks; ++i) {
    if (deafness.look(kBegin + i * kNsPerSecond)) return true;
    between();
  }
  return false;
}

TEST(Deafness, WhatWaitsForTenSecondsIsTakenByNobody) {
  Socket socket(kPort);
  socket.send(15);
  Deafness deafness(kDomain);
  EXPECT_FALSE(deaf_within(deafness, 10, [&] { socket.send(1); }));
  EXPECT_TRUE(deafness.look(kBegin + 10 * kNsPerSecond));
  socket.take(1000);
  EXPECT_FALSE(deafness.look(kBegin + 11 * kNsPerSecond)) << "it was only late";
}

TEST(Deafness, WhatIsFullAndStaysFullIsTakenByNobody) {
  Socket socket(kPort);
  socket.send(2000);
  Deafness deafness(kDomain);
  EXPECT_TRUE(deaf_within(deafness, 12, [&] { socket.send(10); }));
}

TEST(Deafness, WhoIsFarTooSlowHears) {
  Socket socket(kPort);
  socket.send(100);
  Deafness deafness(kDomain);
  int k = 0;
  EXPECT_FALSE(deaf_within(deafness, 60, [&] {
    socket.send(30);
    if (++k % 6 == 0) socket.take(1);
  }));
}

TEST(Deafness, LittleThatWaitsIsNotLookedAt) {
  Socket socket(kPort);
  socket.send(3);
  Deafness deafness(kDomain);
  EXPECT_FALSE(deaf_within(deafness, 60, [] {}));
}

TEST(Deafness, ALookThatTheKernelCutsShortFindsNothing) {
  Socket socket(kPort);
  socket.send(100);
  Deafness deafness(kDomain);
  test::entries_until_failure = 4;
  EXPECT_FALSE(deafness.look(kBegin));
  test::entries_until_failure = -1;
  EXPECT_TRUE(deaf_within(deafness, 12, [] {}));
}

TEST(Deafness, PortsOfOthersAreTheirBusiness) {
  Socket socket(kPort);
  socket.send(100);
  Deafness below(kDomain - 1);
  Deafness above(kDomain + 1);
  EXPECT_FALSE(deaf_within(below, 60, [] {}));
  EXPECT_FALSE(deaf_within(above, 60, [] {}));
}

}  // namespace
}  // namespace fathom::host
