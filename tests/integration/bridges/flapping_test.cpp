// A plug with a loose contact.

#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "heading_by_tcp.hpp"
#include "sim/encode/nmea.hpp"

namespace fathom::test {
namespace {

TEST(HeadingBridge, AConnectionThatFlapsFillsNoLog) {
  constexpr int kFlaps = 100;
  const HeadingByTcp run;
  ASSERT_TRUE(eventually([&] { return run.heading.matched(); })) << run.bridge.output();
  HeadingSample sent;
  sent.heading_rad = 1.0;
  const std::string good = sim::encode::nmea_heading(sent);
  int device = -1;
  for (int i = 0; i < kFlaps; ++i) {
    ASSERT_TRUE(eventually([&] { return (device = connect_to(run.port)) >= 0; })) << run.bridge.output();
    ::send(device, good.data(), good.size() / 2, MSG_NOSIGNAL);  // it breaks off within a sentence
    ::close(device);
  }
  ASSERT_TRUE(eventually([&] { return (device = connect_to(run.port)) >= 0; })) << run.bridge.output();
  EXPECT_TRUE(eventually([&] {
    ::send(device, good.data(), good.size(), MSG_NOSIGNAL);
    return run.heading.count() > 3;
  })) << run.bridge.output();
  ::close(device);
  const std::string log = run.bridge.output();
  EXPECT_LT(std::count(log.begin(), log.end(), '\n'), kFlaps) << log;
}

}  // namespace
}  // namespace fathom::test
