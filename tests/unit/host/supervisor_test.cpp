#include "host/supervisor.hpp"

#include <array>
#include <cstddef>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace fathom::host {
namespace {

TEST(Supervisor, ALifeSignReachesWhoListensAndWaitsForNobodyWhoDoesNot) {
  const int there = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ASSERT_GE(there, 0);
  sockaddr_un own{};
  own.sun_family = AF_UNIX;
  ASSERT_EQ(bind(there, reinterpret_cast<const sockaddr*>(&own), sizeof own.sun_family), 0);
  socklen_t size = sizeof own;
  ASSERT_EQ(getsockname(there, reinterpret_cast<sockaddr*>(&own), &size), 0);
  const std::string name(own.sun_path + 1, size - offsetof(sockaddr_un, sun_path) - 1);
  ASSERT_EQ(setenv("NOTIFY_SOCKET", ("@" + name).c_str(), 1), 0);
  // More than any queue of the kernel holds.
  for (int i = 0; i < 10'000; ++i) supervisor::alive("healthy:\nall is well");
  unsetenv("NOTIFY_SOCKET");
  std::array<char, 128> text{};
  const ssize_t got = recv(there, text.data(), text.size(), MSG_DONTWAIT);
  ASSERT_GT(got, 0);
  EXPECT_EQ(std::string(text.data(), static_cast<std::size_t>(got)),
            "WATCHDOG=1\nSTATUS=healthy: all is well");
  close(there);
}

TEST(Supervisor, WhereNobodyAsksForLifeSignsNothingHappens) {
  unsetenv("NOTIFY_SOCKET");
  supervisor::alive("healthy");
  setenv("NOTIFY_SOCKET", std::string(500, '/').c_str(), 1);
  supervisor::alive("healthy");
  unsetenv("NOTIFY_SOCKET");
}

}  // namespace
}  // namespace fathom::host
