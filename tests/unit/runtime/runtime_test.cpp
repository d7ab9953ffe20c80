#include <algorithm>
#include <array>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>

#include <asio/io_context.hpp>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "runtime/backoff.hpp"
#include "runtime/build_info.hpp"
#include "runtime/byte_link.hpp"
#include "runtime/byte_source.hpp"
#include "runtime/log.hpp"
#include "runtime/refusal_log.hpp"
#include "runtime/reopening.hpp"
#include "support/free_port.hpp"
#include "support/process.hpp"

namespace fathom::runtime {
namespace {

TEST(Backoff, DoublesToItsLimitAndStartsAgain) {
  Backoff backoff(0.1, 5.0);
  EXPECT_DOUBLE_EQ(backoff.next_s(), 0.1);
  EXPECT_DOUBLE_EQ(backoff.next_s(), 0.2);
  EXPECT_DOUBLE_EQ(backoff.next_s(), 0.4);
  for (int i = 0; i < 1000; ++i) (void)backoff.next_s();
  EXPECT_DOUBLE_EQ(backoff.next_s(), 5.0);
  backoff.reset();
  EXPECT_DOUBLE_EQ(backoff.next_s(), 0.1);
}

TEST(SayOnce, SpeaksWhenTheStateChanges) {
  Log log("test", LogLevel::error);  // info is not written: the test stays quiet
  SayOnce once;
  EXPECT_TRUE(once.say(log, LogLevel::info, "lost", "lost"));
  EXPECT_FALSE(once.say(log, LogLevel::info, "lost", "lost again"));
  EXPECT_TRUE(once.say(log, LogLevel::info, "back", "back"));
  once.forget();
  EXPECT_TRUE(once.say(log, LogLevel::info, "back", "back"));
}

TEST(Log, KnowsItsLevels) {
  LogLevel level{};
  EXPECT_TRUE(parse_log_level("warning", level));
  EXPECT_EQ(level, LogLevel::warning);
  EXPECT_FALSE(parse_log_level("warn", level));
}

TEST(Log, AMessageIsOneLineOfPlainText) {
  testing::internal::CaptureStderr();
  Log("test", LogLevel::info).warning("named \"x\n2026 fathom-monitor error: \x1b[31m\"");
  const std::string written = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(written.begin(), written.end(), '\n'), 1);
  EXPECT_EQ(written.find('\x1b'), std::string::npos);
  EXPECT_NE(written.find("x?2026"), std::string::npos) << written;
}

TEST(Log, APipeThatNobodyReadsHoldsNobodyUp) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const int own = dup(STDERR_FILENO);
  ASSERT_EQ(dup2(ends[1], STDERR_FILENO), STDERR_FILENO);
  close(ends[1]);
  std::string written;
  {
    Log log("test", LogLevel::info);
    for (int i = 0; i < 3000; ++i) log.info("line " + std::to_string(i) + std::string(100, '.'));
    EXPECT_FALSE(log.flush());
    std::thread reader([&] {
      std::array<char, 4096> some{};
      for (ssize_t got = 0; (got = read(ends[0], some.data(), some.size())) > 0;)
        written.append(some.data(), static_cast<std::size_t>(got));
    });
    EXPECT_TRUE(log.flush());
    log.info("afterwards");
    EXPECT_TRUE(log.flush());
    dup2(own, STDERR_FILENO);
    reader.join();
  }
  close(own);
  close(ends[0]);
  EXPECT_NE(written.find(" line 2999."), std::string::npos);
  // What is missing is said where it is missing.
  std::istringstream lines(written);
  int taken = 0;
  int said_lost = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto lost = line.find(" lines of this log are lost");
    if (lost == std::string::npos)
      ++taken;
    else
      said_lost += std::stoi(line.substr(line.rfind(' ', lost - 1)));
  }
  EXPECT_GT(said_lost, 1000);
  EXPECT_EQ(taken + said_lost, 3001);
}

TEST(RefusalLog, OneLineAPeriodAndReason) {
  RefusalLog log(10 * kNsPerSecond);
  EXPECT_EQ(*log.add("path", "10.0.0.1: path", 0), "10.0.0.1: path");
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(log.add("path", "10.0.0.1: path", kNsPerSecond));
  EXPECT_TRUE(log.add("token", "10.0.0.1: token", kNsPerSecond)) << "another reason";
  EXPECT_EQ(*log.add("path", "10.0.0.2: path", 11 * kNsPerSecond),
            "10.0.0.2: path, 1001 of them since it was last said");
}

TEST(BuildInfo, HashTellsTextsApart) {
  EXPECT_EQ(hex_hash(""), "cbf29ce484222325");
  EXPECT_EQ(hex_hash("a"), "af63dc4c8601ec8c");  // published test vectors of FNV-1a
  EXPECT_NE(hex_hash("{\"a\":1}"), hex_hash("{\"a\":2}"));
  EXPECT_FALSE(version().empty());
  EXPECT_FALSE(host_name().empty());
}

TEST(Reopening, OfAPortThatFlapsTheNewestStateIsSaid) {
  asio::io_context io;
  std::vector<std::string> said;
  Reopening port(io, "tcp 10.0.0.7:5760", [&](bool is_trouble, const std::string& text) {
    said.push_back((is_trouble ? "! " : "") + text);
  });
  for (int i = 0; i < 50; ++i) {
    port.fail("End of file", [] {});
    port.well();
  }
  EXPECT_EQ(said.size(), 8U) << "a few are said each";
  EXPECT_EQ(said.front(), "! tcp 10.0.0.7:5760: End of file; it is tried again and again");
  port.fail("Connection refused", [] {});
  while (said.size() == 8U && io.run_one() > 0) continue;
  ASSERT_EQ(said.size(), 9U);
  EXPECT_EQ(said.back(),
            "! tcp 10.0.0.7:5760: Connection refused; it is tried again and again, the last of 93 changes");
  port.stop();
}

TEST(ByteLink, ADatagramOfAStrangerIsNamed) {
  const int stranger = ::socket(AF_INET, SOCK_DGRAM, 0);
  ByteLinkConfig config;
  config.address = "127.0.0.2";
  config.bind_port = test::free_port(SOCK_DGRAM);
  std::mutex mutex;
  std::string said;
  ByteLink link(
      config, [](std::span<const std::uint8_t>) {},
      [&](bool is_trouble, const std::string& text) {
        const std::lock_guard lock(mutex);
        if (is_trouble) said = text;
      });
  link.start();
  const sockaddr_in address = test::loopback(config.bind_port);
  EXPECT_TRUE(test::wait_until([&] {
    ::sendto(stranger, "x", 1, 0, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    const std::lock_guard lock(mutex);
    return said ==
           "udp 127.0.0.2:14550: a datagram from 127.0.0.1 is not heard, expected from 127.0.0.2 alone";
  })) << said;
  ::close(stranger);
}

TEST(ByteLink, NothingLeavesBeforeItIsStarted) {
  ByteLinkConfig config;
  config.port = 9;
  ByteLink link(
      config, [](std::span<const std::uint8_t>) {}, [](bool, const std::string&) {});
  link.send({1, 2, 3});
  EXPECT_EQ(link.status().bytes_sent + link.status().bytes_dropped, 0U);
  link.start();
  EXPECT_TRUE(test::wait_until([&] {
    link.send({1, 2, 3});
    return link.status().bytes_sent > 0;
  }));
  const ByteLink unused(
      config, [](std::span<const std::uint8_t>) {}, [](bool, const std::string&) {});
}

TEST(ByteSourceConfig, IsNamedAsPeopleDo) {
  ByteSourceConfig config;
  config.path = "/dev/ttyS1";
  EXPECT_EQ(describe_source(config), "serial /dev/ttyS1");
  config.type = SourceType::tcp_client;
  config.address = "10.0.0.7";
  config.port = 5000;
  EXPECT_EQ(describe_source(config), "tcp 10.0.0.7:5000");
}

TEST(ByteSourceConfig, AddressesAreNumeric) {
  EXPECT_TRUE(is_numeric_address("192.168.1.20"));
  EXPECT_TRUE(is_numeric_address("::1"));
  EXPECT_FALSE(is_numeric_address("dvl.local"));
  EXPECT_FALSE(is_numeric_address("192.168.1"));
  EXPECT_FALSE(is_numeric_address(""));
}

}  // namespace
}  // namespace fathom::runtime
