#include "runtime/byte_source.hpp"

#include <atomic>
#include <chrono>
#include <fstream>
#include <memory>
#include <mutex>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "byte_listener.hpp"
#include "support.hpp"

namespace fathom::runtime {
namespace {

using test::bytes_of;
using test::eventually;
using test::Listener;
using test::quick;

TEST(ByteSource, SerialDeviceThatVanishesAndReturns) {
  const test::TemporaryFolder folder;
  ByteSourceConfig config = quick(SourceType::serial);
  config.silence_s = 60.0;  // a machine that is busy makes pauses
  config.path = folder / "device";
  auto device = std::make_unique<test::SerialDevice>(config.path);
  Listener listener(config);
  ASSERT_TRUE(eventually([&] { return listener.state() == SourceState::connected; }));
  device->send(bytes_of("before"));
  ASSERT_TRUE(eventually([&] { return listener.heard("before"); }));
  device.reset();
  ASSERT_TRUE(eventually([&] { return listener.state() == SourceState::lost; }));
  ASSERT_TRUE(eventually([&] { return listener.status().errors > 5; }));
  device = std::make_unique<test::SerialDevice>(config.path);
  ASSERT_TRUE(eventually([&] { return listener.state() == SourceState::connected; }));
  device->send(bytes_of("after"));
  EXPECT_TRUE(eventually([&] { return listener.heard("after"); }));
  // However many attempts failed, the outage was said once.
  const std::vector<SourceState> expected{SourceState::connected, SourceState::lost, SourceState::connected};
  EXPECT_EQ(listener.events(), expected);
  EXPECT_EQ(listener.status().connects, 2U);
  EXPECT_LT(listener.stop_s(), 0.2);
}

TEST(ByteSource, StaleInputOfASerialPortIsDropped) {
  const test::TemporaryFolder folder;
  ByteSourceConfig config = quick(SourceType::serial);
  config.path = folder / "device";
  const test::SerialDevice device(config.path);
  device.send(bytes_of("stale"));
  Listener listener(config);
  ASSERT_TRUE(eventually([&] { return listener.state() == SourceState::connected; }));
  device.send(bytes_of("fresh"));
  ASSERT_TRUE(eventually([&] { return listener.heard("fresh"); }));
  EXPECT_FALSE(listener.heard("stale"));
}

// While it is silent, and however long that is.
TEST(ByteSource, ASilentDeviceIsAskedAgain) {
  const test::TemporaryFolder folder;
  ByteSourceConfig serial = quick(SourceType::serial);
  serial.path = folder / "device";
  serial.greeting = "tell";
  const test::SerialDevice line(serial.path);
  const Listener reads_line(serial);
  test::TcpDevice peer;
  ByteSourceConfig tcp = quick(SourceType::tcp_client);
  tcp.port = peer.port();
  tcp.greeting = "tell";
  const Listener reads_peer(tcp);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(eventually([&] { return line.heard().find("tell") != std::string::npos; }));
    EXPECT_TRUE(eventually([&] { return peer.heard().find("tell") != std::string::npos; }));
  }
}

TEST(ByteSource, SilenceIsAStateAndEndsWithTheNextByte) {
  const test::TemporaryFolder folder;
  ByteSourceConfig config = quick(SourceType::serial);
  config.path = folder / "device";
  const test::SerialDevice device(config.path);
  Listener listener(config);
  ASSERT_TRUE(eventually([&] { return listener.state() == SourceState::silent; }));
  device.send(bytes_of("x"));
  ASSERT_TRUE(eventually([&] { return listener.heard("x"); }));
  const std::vector<SourceState> expected{SourceState::connected, SourceState::silent,
                                          SourceState::connected};
  EXPECT_EQ(listener.events(), expected);
  EXPECT_EQ(listener.status().connects, 1U);
}

TEST(ByteSource, TcpClientReconnects) {
  auto device = std::make_unique<test::TcpDevice>();
  const int port = device->port();
  ByteSourceConfig config = quick(SourceType::tcp_client);
  config.port = port;
  Listener listener(config);
  ASSERT_TRUE(eventually([&] {
    device->send(bytes_of("one"));
    return listener.heard("one");
  }));
  device.reset();
  ASSERT_TRUE(eventually([&] { return listener.state() == SourceState::lost; }));
  device = std::make_unique<test::TcpDevice>(port);
  EXPECT_TRUE(eventually([&] {
    device->send(bytes_of("two"));
    return listener.heard("two");
  }));
  EXPECT_LT(listener.stop_s(), 0.2);
}

TEST(ByteSource, TcpServerTakesTheNewestConnection) {
  ByteSourceConfig config = quick(SourceType::tcp_server);
  config.port = test::free_port(SOCK_STREAM);
  Listener listener(config);
  int first = -1;
  ASSERT_TRUE(eventually([&] { return (first = test::connect_to(config.port)) >= 0; }));
  ASSERT_EQ(write(first, "first", 5), 5);
  ASSERT_TRUE(eventually([&] { return listener.heard("first"); }));
  const int second = test::connect_to(config.port);
  ASSERT_GE(second, 0);
  ASSERT_EQ(write(second, "second", 6), 6);
  ASSERT_TRUE(eventually([&] { return listener.heard("second"); }));
  // The old connection was closed from our side; the new one counts.
  char end = 0;
  EXPECT_EQ(read(first, &end, 1), 0);
  EXPECT_EQ(listener.state(), SourceState::connected);
  close(first);
  close(second);
  EXPECT_TRUE(eventually([&] { return listener.state() == SourceState::lost; }));
  EXPECT_LT(listener.stop_s(), 0.2);
}

TEST(ByteSource, UdpReceives) {
  ByteSourceConfig config = quick(SourceType::udp);
  config.port = test::free_port(SOCK_DGRAM);
  Listener listener(config);
  ASSERT_TRUE(eventually([&] { return listener.state() == SourceState::connected; }));
  const std::string longest(20'000, 'a');
  test::send_udp(config.port, bytes_of(longest));
  EXPECT_TRUE(eventually([&] { return listener.size() == longest.size(); }));
  EXPECT_LT(listener.stop_s(), 0.2);
}

TEST(ByteSource, UnreachableSourcesStopPromptly) {
  for (const SourceType type : {SourceType::serial, SourceType::tcp_client, SourceType::file}) {
    ByteSourceConfig config = quick(type);
    config.backoff_first_s = 5.0;  // the stop comes in the middle of the wait
    config.path = "/nonexistent/device";
    config.port = test::free_port(SOCK_STREAM);
    Listener listener(config);
    ASSERT_TRUE(eventually([&] { return listener.status().errors > 0; }));
    EXPECT_LT(listener.stop_s(), 0.2);
  }
}

TEST(ByteSource, FileIsPlayedAtItsRateAndOnce) {
  const test::TemporaryFolder folder;
  const std::string content(2000, 'b');
  std::ofstream(folder / "recording") << content;
  ByteSourceConfig config = quick(SourceType::file);
  config.path = folder / "recording";
  config.pace = Pace::rate;
  config.bytes_per_s = 5000.0;
  const auto start = std::chrono::steady_clock::now();
  Listener listener(config);
  ASSERT_TRUE(eventually([&] { return listener.state() == SourceState::finished; }));
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_GT(took_s, 0.35);  // 2000 bytes at 5000 bytes/s
  EXPECT_EQ(listener.size(), content.size());
}

}  // namespace
}  // namespace fathom::runtime
