// Datagrams that end a process which lets Fast DDS read them, sent to one that does not.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus/writer.hpp"
#include "samples/dvl.hpp"
#include "samples/nav_state.hpp"
#include "support.hpp"
#include "support/rtps_datagram.hpp"

namespace fathom::test {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr std::uint32_t kDomain = 109;

/// To every port that a participant of the domain may have.
void send_to_all(const std::vector<rtps::Bytes>& datagrams) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_GE(socket, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (std::uint32_t port = 0; port < 250; ++port) {
    to.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * kDomain + port));
    for (const rtps::Bytes& one : datagrams) {
      // What nobody listens to is refused, which is told with the next.
      (void)sendto(socket, one.data(), one.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
  }
  close(socket);
}

TEST(HostileDatagrams, AreLeftOutCountedAndReported) {
  using rtps::data;
  using rtps::datagram;
  using rtps::submessage;
  bus::Participant fusion(options(kDomain, "fusion"));
  bus::Participant guidance(options(kDomain, "guidance"));
  Events events(guidance);
  Inbox<NavState> inbox;
  bus::Writer<NavState> writer(fusion);
  bus::Reader<NavState> reader(guidance, inbox.handler());
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));

  const rtps::Bytes behind_the_statistics =
      datagram({submessage(rtps::kStatistics, 56), submessage(rtps::kHeartbeat, 28)});
  // To the readers of announcements; its inline QoS ends in the last submessage, which is none.
  rtps::Bytes announcement = data({rtps::parameter(0x8001, 4)}, 0);
  const rtps::Bytes to_and_from{0, 1, 0, 0xC7, 0, 1, 0, 0xC2, 0, 0, 0, 0, 1, 0, 0, 0};
  std::copy(to_and_from.begin(), to_and_from.end(), announcement.begin() + 8);
  const rtps::Bytes endless =
      datagram({announcement, submessage(rtps::kHeartbeat, 28), rtps::parameter(1, 0)});
  send_to_all({behind_the_statistics, endless});

  ASSERT_TRUE(eventually([&] { return guidance.counters().malformed_datagram >= 4; }));
  EXPECT_TRUE(eventually([&] { return fusion.counters().malformed_datagram >= 4; }));
  ASSERT_TRUE(writer.write(NavState{}));
  EXPECT_TRUE(eventually([&] { return inbox.size() == 1; }));
  const auto reported = events.of(bus::BusEventKind::malformed_datagram);
  ASSERT_THAT(reported, SizeIs(1));
  EXPECT_THAT(reported[0].detail, HasSubstr("127.0.0.1"));
}

/// A heartbeat as if from this writer, that it has nothing below sample `leap` (a multiple of 65536).
rtps::Bytes forged_heartbeat(const WriterGuid& writer, std::uint32_t leap) {
  rtps::Bytes heartbeat = rtps::submessage(rtps::kHeartbeat, 28);
  std::fill(heartbeat.begin() + 4, heartbeat.end(), 0);
  std::copy(writer.begin() + 12, writer.end(), heartbeat.begin() + 8);
  for (const std::size_t number : {12U, 20U}) {  // the first and the last that it has, high word first
    heartbeat[number + 6] = static_cast<std::uint8_t>(leap >> 16U);
    heartbeat[number + 7] = static_cast<std::uint8_t>(leap >> 24U);
  }
  heartbeat[30] = 0xFF;  // so many heartbeats it has sent
  rtps::Bytes out = rtps::datagram({heartbeat});
  std::copy(writer.begin(), writer.begin() + 12, out.begin() + 8);
  return out;
}

class ForgedHeartbeats : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));
    ASSERT_TRUE(hears(std::chrono::seconds(5)));
  }
  [[nodiscard]] bool hears(std::chrono::milliseconds patience) {
    const std::size_t before = inbox.size();
    return eventually(
        [&] {
          EXPECT_TRUE(writer.write(DvlSample{}));
          return inbox.size() > before;
        },
        patience);
  }

  bus::Participant bridge{options(kDomain, "dvl_bridge")};
  bus::Participant fusion{options(kDomain, "fusion")};
  Events events{fusion};
  Inbox<DvlSample> inbox;
  bus::Writer<DvlSample> writer{bridge};
  bus::Reader<DvlSample> reader{fusion, inbox.handler()};
};

TEST_F(ForgedHeartbeats, OfALeapThatNoWriterMakesAreLeftOut) {
  send_to_all({forged_heartbeat(writer.guid(), 0x7FFF'0000)});
  EXPECT_TRUE(eventually([&] { return fusion.counters().malformed_datagram > 0; }));
  EXPECT_TRUE(hears(std::chrono::seconds(5)));
}

TEST_F(ForgedHeartbeats, ThatMakeAReaderDeafDoSoForSeconds) {
  send_to_all({forged_heartbeat(writer.guid(), 0x1'0000)});
  let_pass(std::chrono::milliseconds(500));  // what was under way
  ASSERT_FALSE(hears(std::chrono::seconds(1))) << "the forged heartbeat had no effect";
  EXPECT_TRUE(hears(std::chrono::seconds(30)));
  ASSERT_TRUE(eventually([&] { return !events.of(bus::BusEventKind::sample_lost).empty(); }));
  const auto lost = events.of(bus::BusEventKind::sample_lost);
  EXPECT_THAT(lost.back().detail, HasSubstr("another reader was made"));
  EXPECT_EQ(lost.back().topic, "fathom/v1/dvl");
}

}  // namespace
}  // namespace fathom::test
