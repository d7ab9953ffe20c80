// Somebody on the same wire keeps every datagram of a protected vehicle and sends them again, unchanged:
// nothing is delivered twice, and who joins later is not given what is old.

#include <algorithm>
#include <set>
#include <vector>

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <netpacket/packet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "network.hpp"

namespace fathom::test {
namespace {

constexpr std::uint16_t kIpv4 = 0x0800;

struct Datagram {
  std::uint16_t port = 0;  ///< it was sent to
  std::vector<char> payload;
};

/// Ears on the loopback interface, as any program with the right to capture has.
class Sniffer {
 public:
  Sniffer() : socket_(socket(AF_PACKET, SOCK_DGRAM | SOCK_NONBLOCK, htons(kIpv4))) {
    if (socket_ < 0) return;
    sockaddr_ll place{};
    place.sll_family = AF_PACKET;
    place.sll_protocol = htons(kIpv4);
    place.sll_ifindex = static_cast<int>(if_nametoindex("lo"));
    const int room = 32 << 20;
    setsockopt(socket_, SOL_SOCKET, SO_RCVBUFFORCE, &room, sizeof room);
    if (bind(socket_, reinterpret_cast<sockaddr*>(&place), sizeof place) != 0) {
      close(socket_);
      socket_ = -1;
    }
  }
  ~Sniffer() {
    if (socket_ >= 0) close(socket_);
  }
  Sniffer(const Sniffer&) = delete;
  Sniffer& operator=(const Sniffer&) = delete;

  [[nodiscard]] bool permitted() const { return socket_ >= 0; }

  /// What has passed since the last call: RTPS to the ports from `first` to `last`.
  std::vector<Datagram> take(std::uint16_t first, std::uint16_t last) {
    std::vector<Datagram> out;
    std::vector<char> bytes(65536);
    for (;;) {
      sockaddr_ll from{};
      socklen_t length = sizeof from;
      const ssize_t got =
          recvfrom(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &length);
      if (got < 0) return out;
      const std::size_t header = 4U * (static_cast<unsigned char>(bytes[0]) & 15U);
      if (from.sll_pkttype == PACKET_OUTGOING || bytes[9] != IPPROTO_UDP ||
          static_cast<std::size_t>(got) < header + 12) {
        continue;
      }
      const auto* udp = reinterpret_cast<const unsigned char*>(bytes.data()) + header;
      const auto port = static_cast<std::uint16_t>(udp[2] << 8U | udp[3]);
      const char* payload = bytes.data() + header + 8;
      if (port < first || port > last || std::string_view(payload, 4) != "RTPS") continue;
      const char* end = bytes.data() + got;
      out.push_back({port, std::vector<char>(payload, end)});
    }
  }

 private:
  int socket_;
};

void send(const std::vector<Datagram>& datagrams, const std::set<std::uint16_t>& besides = {}) {
  const int out = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto send_to = [&](const Datagram& one, std::uint16_t port) {
    to.sin_port = htons(port);
    (void)sendto(out, one.payload.data(), one.payload.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
  };
  for (const Datagram& one : datagrams) {
    send_to(one, one.port);
    for (const std::uint16_t port : besides) send_to(one, port);
  }
  close(out);
}

/// Each from the first on, once, in order.
void expect_each_once(const std::vector<std::uint64_t>& sequences) {
  ASSERT_FALSE(sequences.empty());
  for (std::size_t i = 1; i < sequences.size(); ++i)
    ASSERT_EQ(sequences[i], sequences[i - 1] + 1) << "at " << i;
}

class Replay : public testing::Test {
 protected:
  static constexpr std::uint32_t kDomain = 59;
  static constexpr std::uint16_t kFirst = 7400 + 250 * kDomain;  // the ports of the domain, RTPS 9.6.1.1
  static constexpr std::uint16_t kLast = kFirst + 249;

  void SetUp() override {
    if (!sniffer.permitted()) GTEST_SKIP() << "capturing on lo is not permitted (it needs CAP_NET_RAW)";
  }
  /// A second and more of the network's traffic, discovery and handshakes included.
  std::vector<Datagram> record(SecureNetwork& network) {
    EXPECT_TRUE(network.goes_on(100));
    EXPECT_TRUE(network.pause());
    return sniffer.take(kFirst, kLast);
  }

  Sniffer sniffer;
};

TEST_F(Replay, NothingIsDeliveredTwice) {
  SecureNetwork network(kDomain);
  const auto datagrams = record(network);
  ASSERT_GT(datagrams.size(), 100U);
  const auto before = network.sequences();
  expect_each_once(before);
  send(datagrams);
  // What is sent afterwards comes after it.
  network.resume();
  EXPECT_TRUE(network.goes_on());
  ASSERT_TRUE(network.pause());
  const auto after = network.sequences();
  EXPECT_GT(after.size(), before.size());
  expect_each_once(after);
  EXPECT_EQ(after.back(), network.written());
  EXPECT_EQ(network.forged(), 0U);
}

/// How many of the datagrams have this text in them.
std::size_t count_with(const std::vector<Datagram>& datagrams, std::string_view text) {
  return static_cast<std::size_t>(std::count_if(datagrams.begin(), datagrams.end(), [&](const Datagram& one) {
    return std::string_view(one.payload.data(), one.payload.size()).find(text) != std::string_view::npos;
  }));
}

// Certificates and permissions are shown in the handshake, as DDS Security has it; samples and discovery are
// not.
TEST_F(Replay, NoSampleAndNoTypeCanBeRead) {
  constexpr std::string_view kType = "fathom::v1::NavState";
  {
    SecureNetwork network(kDomain);
    const auto datagrams = record(network);
    ASSERT_GT(datagrams.size(), 100U);
    EXPECT_EQ(count_with(datagrams, kSampleMark), 0U);
    EXPECT_EQ(count_with(datagrams, kType), 0U);
  }
  // The ears are good: where nothing is protected they hear both.
  bus::Participant fusion(options(kDomain, "fusion"));
  bus::Participant guidance(options(kDomain, "guidance"));
  bus::Writer<NavState> writer(fusion);
  Inbox<NavState> inbox;
  bus::Reader<NavState> reader(guidance, inbox.handler());
  ASSERT_TRUE(
      eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }, kPatience));
  NavState state;
  state.header.sensor = kSampleMark;
  writer.write(state);
  ASSERT_TRUE(eventually([&] { return inbox.size() == 1; }, kPatience));
  const auto datagrams = sniffer.take(kFirst, kLast);
  EXPECT_GT(count_with(datagrams, kSampleMark), 0U);
  EXPECT_GT(count_with(datagrams, kType), 0U);
}

TEST_F(Replay, WhoJoinsLaterIsNotGivenWhatIsOld) {
  SecureNetwork network(kDomain);
  const auto datagrams = record(network);
  ASSERT_GT(datagrams.size(), 100U);
  const std::uint64_t old = network.written();
  bus::Participant monitor(network.options("monitor"));
  Inbox<NavState> inbox;
  bus::Reader<NavState> reader(monitor, inbox.handler());
  ASSERT_TRUE(eventually([&] { return reader.matched_writers() == 1; }, kPatience));
  std::set<std::uint16_t> ports;  // where a participant of number n listens
  for (std::uint16_t n = 0; n < 8; ++n) {
    ports.insert(kFirst + 10 + 2 * n);
    ports.insert(kFirst + 11 + 2 * n);
  }
  send(datagrams, ports);
  network.resume();
  ASSERT_TRUE(eventually([&] { return inbox.size() > 50; }, kPatience));
  for (const auto& [state, info] : inbox.all()) EXPECT_GT(state.header.sequence, old);
  EXPECT_TRUE(network.goes_on());
  ASSERT_TRUE(network.pause());
  expect_each_once(network.sequences());
}

}  // namespace
}  // namespace fathom::test
