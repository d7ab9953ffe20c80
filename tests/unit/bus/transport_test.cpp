// What stands between Fast DDS and the sockets: who is sent a datagram first, and what is not let in.

#include "bus/detail/network/transport.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/detail/network/low_priority_peers.hpp"
#include "bus/detail/security/datagram_check.hpp"
#include "support/dds_socket.hpp"
#include "support/free_port.hpp"
#include "support/rtps_datagram.hpp"
#include "unit/bus/bodies.hpp"

namespace fathom::bus::detail {
namespace {

using test::rtps::Bytes;
using test::rtps::data;
using test::rtps::datagram;
using test::rtps::kHeartbeat;
using test::rtps::kStatistics;
using test::rtps::kTimestamp;
using test::rtps::parameter;
using test::rtps::put_u16;
using test::rtps::submessage;
using testing::ElementsAre;
using testing::IsEmpty;
using Locators = std::vector<rtps::Locator_t>;

rtps::Locator_t locator(std::uint32_t port, const std::string& address = "127.0.0.1") {
  rtps::Locator_t out;
  rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, address, port, out);
  return out;
}

GuidPrefix prefix_to(std::uint8_t last) {
  GuidPrefix out{};
  out[11] = last;
  return out;
}

std::vector<std::uint32_t> ports(const Locators& locators) {
  std::vector<std::uint32_t> out;
  for (const rtps::Locator_t& one : locators) out.push_back(one.port);
  return out;
}

std::vector<std::uint32_t> ordered(const LowPriorityPeers& low_priority_peers, Locators destinations) {
  low_priority_peers.to_the_back(destinations);
  return ports(destinations);
}

TEST(LowPriorityPeers, ComeLastAndTheOrderStaysOtherwise) {
  LowPriorityPeers low_priority_peers;
  const Locators all{locator(1), locator(2), locator(3), locator(4), locator(5)};
  EXPECT_THAT(ordered(low_priority_peers, all), ElementsAre(1, 2, 3, 4, 5));
  low_priority_peers.seen(prefix_to(1), {locator(4)});
  low_priority_peers.seen(prefix_to(2), {locator(1), locator(1, "10.0.0.9")});
  EXPECT_THAT(ordered(low_priority_peers, all), ElementsAre(2, 3, 5, 1, 4));
  EXPECT_THAT(ordered(low_priority_peers, {locator(1), locator(4)}), ElementsAre(1, 4));
  EXPECT_THAT(ordered(low_priority_peers, {}), IsEmpty());
}

TEST(LowPriorityPeers, AnotherAddressIsAnotherReceiver) {
  LowPriorityPeers low_priority_peers;
  low_priority_peers.seen(prefix_to(1), {locator(1, "10.0.0.9")});
  EXPECT_THAT(ordered(low_priority_peers, {locator(1), locator(2)}), ElementsAre(1, 2));
}

TEST(LowPriorityPeers, OneThatMovedOrLeftIsNotAskedForWhereItWas) {
  LowPriorityPeers low_priority_peers;
  low_priority_peers.seen(prefix_to(1), {locator(1)});
  low_priority_peers.seen(prefix_to(1), {locator(2)});
  EXPECT_THAT(ordered(low_priority_peers, {locator(1), locator(2), locator(3)}), ElementsAre(1, 3, 2));
  low_priority_peers.gone(prefix_to(1));
  EXPECT_THAT(ordered(low_priority_peers, {locator(1), locator(2), locator(3)}), ElementsAre(1, 2, 3));
}

TEST(Harmless, WhatFastDdsAndOthersSend) {
  EXPECT_TRUE(harmless(
      datagram({submessage(kTimestamp, 8), submessage(kHeartbeat, 300), submessage(kStatistics, 56)})));
  EXPECT_TRUE(harmless(datagram({submessage(kHeartbeat, 20, false), submessage(kStatistics, 56, false)})));
  EXPECT_TRUE(harmless(datagram({submessage(kTimestamp, 0), submessage(kHeartbeat, 20)})));
  EXPECT_TRUE(harmless(datagram({})));
  EXPECT_TRUE(harmless({}));
}

TEST(Harmless, DataWithAndWithoutInlineQos) {
  for (const bool little : {true, false}) {
    EXPECT_TRUE(harmless(datagram({data({}, 156, little), submessage(kStatistics, 56)})));
    EXPECT_TRUE(harmless(datagram({data({}, 0, little)})));
    EXPECT_TRUE(
        harmless(datagram({data({parameter(0x70, 16, little), parameter(1, 0, little)}, 40, little)})));
    EXPECT_TRUE(harmless(datagram({data({parameter(0x71, 4, little), parameter(1, 0, little)}, 0, little)})));
    EXPECT_TRUE(harmless(datagram({data({parameter(1, 0, little)}, 100, little, -1, true)})));
    EXPECT_TRUE(
        harmless(datagram({data({parameter(1, 300, little)}, 4, little)})));  // a sentinel has no content
  }
}

TEST(Harmless, NotDataWhoseInlineQosGoesOnBehindItsEnd) {
  for (const bool fragment : {true, false}) {
    for (const bool little : {true, false}) {
      const auto cut = [&](const std::vector<Bytes>& inline_qos) {
        return harmless(datagram({data(inline_qos, 0, little, -1, fragment), submessage(kHeartbeat, 200)}));
      };
      EXPECT_TRUE(cut({parameter(0x70, 16, little), parameter(1, 0, little)}));
      EXPECT_FALSE(cut({parameter(0x70, 16, little)}));
      Bytes longer = parameter(0x70, 16, little);
      put_u16(longer, 2, 100, little);
      EXPECT_FALSE(cut({longer, parameter(1, 0, little)}));
      EXPECT_FALSE(cut({Bytes{1, 0}}));
    }
  }
}

TEST(Harmless, NotDataWhoseContentBeginsElsewhere) {
  EXPECT_TRUE(harmless(datagram({data({}, 20, true, 36)})));
  for (const int offset : {0, 15, 37, 0x7FFF, 0x8000, 0xFFFF}) {
    EXPECT_FALSE(harmless(datagram({data({}, 20, true, offset), submessage(kHeartbeat, 200)}))) << offset;
  }
  EXPECT_FALSE(harmless(datagram({submessage(0x15, 19)})));
  EXPECT_FALSE(harmless(datagram({submessage(0x16, 31)})));
}

TEST(Harmless, NotAFragmentThatItsSampleDoesNotHave) {
  for (const bool little : {true, false}) {
    const Bytes good = data({}, 100, little, -1, true);
    EXPECT_TRUE(harmless(datagram({good})));
    const auto with = [&](std::size_t at, unsigned value) {
      Bytes changed = good;
      put_u16(changed, at, value, little);
      return harmless(datagram({changed}));
    };
    const std::size_t low = little ? 0 : 2;
    EXPECT_TRUE(with(24 + low, 3));
    EXPECT_FALSE(with(24 + low, 4));
    EXPECT_FALSE(with(24 + low, 0));
    EXPECT_FALSE(with(26 - low, 1));  // of the upper half
    EXPECT_TRUE(with(28, 2));
    EXPECT_FALSE(with(28, 3));
    EXPECT_FALSE(with(28, 0));
    EXPECT_FALSE(with(30, 0));
    EXPECT_FALSE(with(32 + low, 100));
  }
}

TEST(Harmless, NotWithAnythingBehindTheStatistics) {
  EXPECT_FALSE(harmless(datagram({submessage(kStatistics, 56), submessage(kHeartbeat, 20)})));
  EXPECT_FALSE(harmless(datagram({submessage(kStatistics, 56, false), {0}})));
  EXPECT_FALSE(
      harmless(datagram({submessage(kTimestamp, 0), submessage(kStatistics, 56), submessage(1, 0)})));
  EXPECT_FALSE(harmless(datagram({submessage(kHeartbeat, 18), {0, 0}, submessage(kStatistics, 56), {0, 0}})));
}

TEST(Harmless, TheSameOfAnotherVendorMeansSomethingElse) {
  EXPECT_TRUE(harmless(datagram({submessage(kStatistics, 56), submessage(kHeartbeat, 20)}, 0x10)));
}

TEST(Harmless, WhatFastDdsDoesNotWalkToDoesNoHarm) {
  Bytes beyond = submessage(kHeartbeat, 20);
  beyond[2] = 0xFF;
  EXPECT_TRUE(harmless(datagram({beyond, submessage(kStatistics, 56), {0}})));
  EXPECT_TRUE(harmless(datagram({submessage(kHeartbeat, 0), submessage(kStatistics, 56), {0}})));
}

TEST(Harmless, AnyCutOfADatagramIsJudgedWithinItsBytes) {
  const Bytes whole =
      datagram({submessage(kTimestamp, 8), submessage(kStatistics, 56), submessage(kHeartbeat, 20)});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(harmless(cut), size <= 20 + 12 + 60) << size;
  }
}

class Transports : public testing::Test {
 protected:
  Transports()
      : transport(dynamic_cast<fastdds::ChainingTransport*>(
            TransportDescriptor(std::make_shared<fastdds::UDPv4TransportDescriptor>(), low_priority_peers,
                                delivery_watch, acknowledgements,
                                [this](const std::string& address) { refused.push_back(address); })
                .create_transport())) {}

  const std::shared_ptr<LowPriorityPeers> low_priority_peers = std::make_shared<LowPriorityPeers>();
  const std::shared_ptr<DeliveryWatch> delivery_watch = std::make_shared<DeliveryWatch>();
  const std::shared_ptr<AcknowledgementBook> acknowledgements = std::make_shared<AcknowledgementBook>();
  std::vector<std::string> refused;
  const std::unique_ptr<fastdds::ChainingTransport> transport;
};

TEST_F(Transports, CallForNoHeartbeatBesideThePeriodicOnes) {
  // More than a batch is counted for: of a thousand samples of 1,500 bytes the sum over all before each.
  EXPECT_GT(transport->get_configuration()->min_send_buffer_size(), 750'000'000U);
}

TEST_F(Transports, SendToLowPriorityPeersLast) {
  low_priority_peers->seen(prefix_to(1), {locator(7413)});
  rtps::LocatorList_t list;
  for (const std::uint32_t port : {7411, 7413, 7415}) list.push_back(locator(port));
  fastdds::Locators from(list.begin());
  fastdds::Locators to(list.end());
  test::DdsSocket socket;
  const Bytes bytes{1, 2, 3};
  EXPECT_TRUE(socket.send_over(*transport, bytes, &from, &to));
  EXPECT_EQ(socket.sent, bytes);
  EXPECT_THAT(ports(socket.at), ElementsAre(7411, 7415, 7413));
  socket.works = false;
  EXPECT_FALSE(socket.send_over(*transport, bytes, &from, &to));
}

TEST_F(Transports, SendToAPeerBeforeFastDdsHasOpenedAChannelToIt) {
  const int peer = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int port = test::free_port(SOCK_DGRAM);
  const sockaddr_in place = test::loopback(port);
  ASSERT_EQ(bind(peer, reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);
  ASSERT_TRUE(transport->init());
  fastdds::SendResourceList sockets;
  ASSERT_TRUE(transport->OpenOutputChannel(sockets, locator(7411)));
  ASSERT_FALSE(sockets.empty());
  const std::size_t opened = sockets.size();
  const Bytes bytes = datagram({submessage(kHeartbeat, 20), submessage(kStatistics, 56)});
  for (int round = 0; round < 2; ++round) {
    rtps::LocatorList_t list;
    list.push_back(locator(static_cast<std::uint32_t>(port)));
    fastdds::Locators from(list.begin());
    fastdds::Locators to(list.end());
    ASSERT_TRUE(test::send_by(*sockets.front(), bytes, &from, &to));
    Bytes arrived(1'000);
    const ssize_t size = recv(peer, arrived.data(), arrived.size(), 0);
    EXPECT_EQ(size, static_cast<ssize_t>(bytes.size()));
  }
  EXPECT_EQ(sockets.size(), opened);
  close(peer);
}

TEST_F(Transports, LetInWhatIsHarmlessAndNameTheSenderOfTheRest) {
  Dds dds;
  const Bytes good = datagram({submessage(kHeartbeat, 20), submessage(kStatistics, 56)});
  Bytes bad = good;
  bad.push_back(0);
  for (const Bytes* one : {&good, static_cast<const Bytes*>(&bad), &good}) {
    transport->receive(&dds, one->data(), static_cast<std::uint32_t>(one->size()), locator(7411),
                       locator(40000, "10.0.0.66"));
  }
  EXPECT_THAT(dds.received, ElementsAre(good, good));
  EXPECT_THAT(refused, ElementsAre("10.0.0.66"));
}

}  // namespace
}  // namespace fathom::bus::detail
