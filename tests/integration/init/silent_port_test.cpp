// Why a port is silent, as the system tells it, and that none is listened to that another process reads.
#include <array>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <pty.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/command.hpp"
#include "cli/init/listening.hpp"
#include "runtime/serial/serial_holders.hpp"
#include "support/process.hpp"

namespace fathom::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A pseudo-terminal whose device is this process.
class Line {
 public:
  Line() {
    std::array<char, 64> name{};
    if (openpty(&device_, &line_, name.data(), nullptr, nullptr) != 0) throw std::runtime_error("openpty");
    fcntl(device_, F_SETFD, FD_CLOEXEC);
    fcntl(line_, F_SETFD, FD_CLOEXEC);
    path_ = name.data();
  }
  ~Line() {
    close(device_);
    close(line_);
  }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  int device_ = -1;
  int line_ = -1;
  std::string path_;
};

std::string trouble_of(const PortToHear& port) {
  const SystemClock clock;
  const std::vector<Heard> heard = listen({port}, 0.5, clock);
  EXPECT_EQ(heard.at(0).bytes, 0U);
  return heard.at(0).trouble;
}

std::string refusal_of(const std::string& path) {
  try {
    refuse_ports_in_use({serial_port(path)});
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_configuration);
    return failure.what();
  }
  return "";
}

/// A port of this host that nobody listens at.
int refused_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  bind(socket, reinterpret_cast<sockaddr*>(&address), size);
  getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  close(socket);
  return ntohs(address.sin_port);
}

TEST(InitSilentPort, SaysWhatTheSystemSays) {
  EXPECT_THAT(trouble_of(serial_port("/dev/nope")),
              AllOf(HasSubstr("/dev/nope"), HasSubstr("No such file or directory")));
  EXPECT_THAT(trouble_of(serial_port("/etc/passwd")), HasSubstr("/etc/passwd: is no serial port"));
  EXPECT_THAT(trouble_of(tcp_port("127.0.0.1:" + std::to_string(refused_port()))),
              HasSubstr("Connection refused"));
  const Line silent;
  EXPECT_EQ(trouble_of(serial_port(silent.path())), "") << "open, and nothing comes";
}

TEST(InitSilentPort, SaysWhatHelpsWhereTheRightsAreMissing) {
  if (geteuid() != 0) GTEST_SKIP() << "needs another user's device";
  const Line line;
  ASSERT_EQ(chmod(line.path().c_str(), 0600), 0);
  ASSERT_EQ(seteuid(65'534), 0);
  const std::string own = trouble_of(serial_port(line.path()));
  ASSERT_EQ(seteuid(0), 0);
  EXPECT_THAT(own, AllOf(HasSubstr("Permission denied"), HasSubstr("its mode 0600 lets only root")));
  constexpr gid_t kGroup = 54'321;
  ASSERT_EQ(chown(line.path().c_str(), 0, kGroup), 0);
  ASSERT_EQ(chmod(line.path().c_str(), 0660), 0);
  ASSERT_EQ(seteuid(65'534), 0);
  const std::string of_group = trouble_of(serial_port(line.path()));
  ASSERT_EQ(seteuid(0), 0);
  EXPECT_THAT(of_group, AllOf(HasSubstr("Permission denied"), HasSubstr("usermod -a -G 54321")));
}

TEST(InitPortInUse, IsRefusedWithItsHolder) {
  const Line line;
  EXPECT_EQ(refusal_of(line.path()), "") << "its device is no other reader";
  {
    const test::Process reader("/bin/sh", {"-c", "exec 3<" + line.path() + "; exec sleep 600"});
    ASSERT_TRUE(test::wait_until([&] { return !runtime::serial_holders(line.path()).empty(); }));
    EXPECT_THAT(refusal_of(line.path()),
                AllOf(HasSubstr(line.path()), HasSubstr("process " + std::to_string(reader.pid()))));
  }
  EXPECT_EQ(refusal_of(line.path()), "");
}

TEST(InitPortInUse, AReaderOfOursKeepsOthersOut) {
  const Line line;
  const SystemClock clock;
  PortToHear port = serial_port(line.path());
  const auto open = [&] {
    auto source = std::make_unique<runtime::ByteSource>(
        port.port, clock, [](std::span<const std::uint8_t>, const runtime::Arrival&) {},
        [](const runtime::SourceEvent&) {});
    source->start();
    return source;
  };
  auto bridge = open();
  ASSERT_TRUE(test::wait_until([&] { return bridge->status().state == runtime::SourceState::connected; }));
  EXPECT_THAT(refusal_of(line.path()), HasSubstr("is in use by another process"));
  const auto second = open();
  ASSERT_TRUE(test::wait_until([&] { return second->status().errors > 0; }));
  EXPECT_THAT(second->status().detail, HasSubstr("is in use by"));
  bridge.reset();
  EXPECT_TRUE(test::wait_until([&] { return second->status().state == runtime::SourceState::connected; }));
}

}  // namespace
}  // namespace fathom::cli
