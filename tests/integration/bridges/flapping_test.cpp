// A plug with a loose contact.

#include <string>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "samples/heading.hpp"
#include "sim/encode/nmea.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t out = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++out;
  return out;
}

TEST(HeadingBridge, AConnectionThatFlapsFillsNoLog) {
  constexpr int kDomain = 144;
  constexpr std::size_t kFlaps = 100;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<HeadingSample> heading(participant);
  const int port = free_port(SOCK_STREAM);
  const Process bridge(
      "fathom-heading-bridge",
      bridge_arguments("heading", kDomain,
                       {R"(sensors.0.source={"type":"tcp_server","port":)" + std::to_string(port) + "}"}),
      folder / "log");
  ASSERT_TRUE(eventually([&] { return heading.matched(); })) << bridge.output();
  HeadingSample sent;
  sent.heading_rad = 1.0;
  const std::string good = sim::encode::nmea_heading(sent);
  int device = -1;
  for (std::size_t i = 0; i < kFlaps; ++i) {
    ASSERT_TRUE(eventually([&] { return (device = connect_to(port)) >= 0; })) << bridge.output();
    ::send(device, good.data(), good.size() / 2, MSG_NOSIGNAL);  // it breaks off within a sentence
    ::close(device);
  }
  ASSERT_TRUE(eventually([&] { return (device = connect_to(port)) >= 0; })) << bridge.output();
  EXPECT_TRUE(eventually([&] {
    ::send(device, good.data(), good.size(), MSG_NOSIGNAL);
    return heading.count() > 3;
  })) << bridge.output();
  ::close(device);
  EXPECT_LT(count(bridge.output(), "\n"), kFlaps) << bridge.output();
}

}  // namespace
}  // namespace fathom::test
