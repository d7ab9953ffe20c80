// The bridge of told positions as a process of its own.

#include "samples/position/fix.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/clock.hpp"
#include "sim/encode/fix_text.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

void send_line(int port, const std::string& line) {
  const int out = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  (void)sendto(out, line.data(), line.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  close(out);
}

TEST(FixBridge, ALineOfMinutesAgoKeepsItsInstantAndOneOfNoInstantIsRefused) {
  constexpr int kDomain = 149;
  constexpr int kPort = 17149;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<FixSample> fixes(participant);
  const Process bridge("fathom-fix-bridge",
                       bridge_arguments("fix", kDomain,
                                        {R"(sensors.0.source={"type":"udp","address":"127.0.0.1","port":)" +
                                             std::to_string(kPort) + "}",
                                         "sensors.0.max_age_s=1800"}),
                       folder / "log");
  ASSERT_TRUE(eventually([&] { return fixes.matched(); })) << bridge.output();
  FixSample told;
  told.header.stamp_ns = (SystemClock().utc_ns() / kNsPerSecond - 600) * kNsPerSecond;
  told.latitude_rad = 0.6;
  told.longitude_rad = 2.2;
  told.sigma_m = 20.0;
  FixSample ancient = told;
  ancient.header.stamp_ns -= 3600 * kNsPerSecond;
  ancient.sigma_m = 30.0;
  ASSERT_TRUE(eventually([&] {
    send_line(kPort, sim::encode::fix_text(ancient));
    send_line(kPort, sim::encode::fix_text(told));
    send_line(kPort, "$PFTHX,,36.4009,127.4,10\n");  // by hand, of now
    return fixes.count() > 5;
  })) << bridge.output();
  int minutes_old = 0;
  int new_ones = 0;
  for (const FixSample& fix : fixes.all()) {
    EXPECT_EQ(fix.header.sensor, Name("ship"));
    EXPECT_NE(fix.sigma_m, 30.0);
    if (fix.sigma_m == 20.0) {
      EXPECT_EQ(fix.header.stamp_ns, told.header.stamp_ns);
      EXPECT_GT(fix.header.received_ns, told.header.stamp_ns + 590 * kNsPerSecond);
      ++minutes_old;
    } else {
      EXPECT_LT(fix.header.received_ns - fix.header.stamp_ns, kNsPerSecond);
      ++new_ones;
    }
  }
  EXPECT_GT(minutes_old, 0);
  EXPECT_GT(new_ones, 0);
}

}  // namespace
}  // namespace fathom::test
