// Participants that know nobody but a discovery server, which comes, goes and comes back.

#include <cstdlib>
#include <memory>

#include <sys/socket.h>

#include "bus/writer.hpp"
#include "samples/imu.hpp"
#include "support.hpp"
#include "support/free_port.hpp"

namespace fathom::test {
namespace {

constexpr milliseconds kPatience(60'000);

/// Where a discovery server may listen.
std::string free_address() {
  return "127.0.0.1:" + std::to_string(free_port(SOCK_DGRAM));
}

bus::ParticipantOptions client(std::uint32_t domain, const std::string& name, const std::string& server) {
  bus::ParticipantOptions out = options(domain, name);
  out.peers = {};
  out.discovery_servers = {server};
  return out;
}

bus::ParticipantOptions server(std::uint32_t domain, const std::string& address) {
  bus::ParticipantOptions out = options(domain, "discovery");
  out.peers = {};
  out.discovery_listen = address;
  return out;
}

std::uint32_t domain_variable() {
  return static_cast<std::uint32_t>(std::stoul(variable("TEST_DOMAIN")));
}

/// Body of a child: a client that writes until stopped.
TEST(ChildServer, DISABLED_Writes) {
  bus::Participant participant(client(domain_variable(), "imu_bridge", variable("TEST_ADDRESS")));
  bus::Writer<ImuSample> writer(participant);
  until_stopped(milliseconds(20), [&] { writer.write(ImuSample{}); });
}

/// Body of a child: a discovery server until stopped.
TEST(ChildServer, DISABLED_Serves) {
  const bus::Participant participant(server(domain_variable(), variable("TEST_ADDRESS")));
  until_stopped(milliseconds(100), [] {});
}

std::unique_ptr<Child> start(const std::string& body, std::uint32_t domain, const std::string& address) {
  return std::make_unique<Child>(
      "ChildServer.DISABLED_" + body,
      std::vector<std::string>{"TEST_DOMAIN=" + std::to_string(domain), "TEST_ADDRESS=" + address});
}
std::unique_ptr<Child> start_server(std::uint32_t domain, const std::string& address) {
  return start("Serves", domain, address);
}

/// Somebody who writes, somebody who reads, and both know the server only.
struct Pair {
  Pair(std::uint32_t domain, const std::string& name, const std::string& server)
      : a(client(domain, name + "_writer", server)), b(client(domain, name + "_reader", server)) {}
  bool matched() { return writer.matched_readers() > 0 && reader.matched_writers() > 0; }
  /// A sample written now arrives.
  bool delivers() {
    const std::size_t before = inbox.size();
    writer.write(ImuSample{});
    return eventually([&] { return inbox.size() > before; }, kPatience);
  }
  bus::Participant a;
  bus::Participant b;
  bus::Writer<ImuSample> writer{a};
  Inbox<ImuSample> inbox;
  bus::Reader<ImuSample> reader{b, inbox.handler()};
};

TEST(DiscoveryServer, ParticipantsThatKnowOnlyTheServerFindEachOther) {
  const std::string address = free_address();
  Pair pair(130, "pair", address);
  let_pass(milliseconds(300));
  EXPECT_FALSE(pair.matched()) << "they know each other without a server";
  const auto serving = start_server(130, address);
  ASSERT_TRUE(eventually([&] { return pair.matched(); }, kPatience));
  EXPECT_TRUE(pair.delivers());
}

TEST(DiscoveryServer, MatchesOutliveItAndNewOnesAreMadeWhenItIsBack) {
  const std::string address = free_address();
  auto serving = start_server(131, address);
  Pair old(131, "old", address);
  ASSERT_TRUE(eventually([&] { return old.matched(); }, kPatience));
  const Events at_reader(old.b);
  serving->kill_hard();
  // Until the clients have given the server up: nobody unmatches anybody because of that.
  ASSERT_TRUE(eventually([&] { return old.b.peers().size() == 1 && old.a.peers().size() == 1; }, kPatience));
  EXPECT_TRUE(old.matched());
  EXPECT_TRUE(old.delivers());

  Pair young(131, "young", address);
  EXPECT_TRUE(old.delivers());
  EXPECT_FALSE(young.matched());
  serving = start_server(131, address);
  ASSERT_TRUE(eventually([&] { return young.matched(); }, kPatience));
  // A writer that has met the old reader alone would write past its own.
  ASSERT_TRUE(eventually(
      [&] {
        return old.writer.matched_readers() == 2 && young.writer.matched_readers() == 2 &&
               young.reader.matched_writers() == 2;
      },
      kPatience))
      << "old and young have met: " << old.writer.matched_readers() << ", " << young.writer.matched_readers();
  EXPECT_TRUE(young.delivers());
  EXPECT_TRUE(old.delivers());
  EXPECT_TRUE(at_reader.of(bus::BusEventKind::writer_lost).empty());
}

TEST(DiscoveryServer, RestartedBeforeAnybodyNoticedItServesAgain) {
  const std::string address = free_address();
  auto serving = start_server(132, address);
  Pair old(132, "old", address);
  ASSERT_TRUE(eventually([&] { return old.matched(); }, kPatience));
  serving->kill_hard();
  serving = start_server(132, address);
  Pair young(132, "young", address);
  ASSERT_TRUE(eventually([&] { return young.matched(); }, kPatience));
  ASSERT_TRUE(eventually(
      [&] { return old.writer.matched_readers() == 2 && young.writer.matched_readers() == 2; }, kPatience))
      << "old and young have met: " << old.writer.matched_readers() << ", " << young.writer.matched_readers();
  EXPECT_TRUE(old.delivers());
  EXPECT_TRUE(young.delivers());
}

TEST(DiscoveryServer, AKilledClientIsGivenUpByTheOthers) {
  const std::string address = free_address();
  const auto serving = start_server(138, address);
  bus::Participant participant(client(138, "fusion", address));
  Inbox<ImuSample> inbox;
  bus::Reader<ImuSample> reader(participant, inbox.handler());
  for (std::uint64_t round = 1; round <= 2; ++round) {
    const std::size_t before = inbox.size();
    const auto writing = start("Writes", 138, address);
    ASSERT_TRUE(eventually([&] { return inbox.size() > before + 5; }, kPatience));
    writing->kill_hard();
    ASSERT_TRUE(eventually([&] { return reader.matched_writers() == 0; }, kPatience));
    ASSERT_TRUE(eventually([&] { return participant.peers().size() == 1; }, kPatience))
        << "the server remains";
  }
}

TEST(DiscoveryServer, AnotherDomainIsNotServed) {
  const std::string address = free_address();
  const auto serving = start_server(133, address);
  Pair own(133, "own", address);
  Pair other(134, "other", address);
  ASSERT_TRUE(eventually([&] { return own.matched(); }, kPatience));
  EXPECT_FALSE(other.matched());
  EXPECT_TRUE(other.a.peers().empty());
}

TEST(DiscoveryServer, AServerTakesPartItself) {
  const std::string address = free_address();
  bus::Participant serving(server(135, address));
  bus::Writer<ImuSample> writer(serving);
  bus::Participant listening(client(135, "listening", address));
  Inbox<ImuSample> inbox;
  bus::Reader<ImuSample> reader(listening, inbox.handler());
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1; }, kPatience));
  writer.write(ImuSample{});
  EXPECT_TRUE(eventually([&] { return inbox.size() == 1; }, kPatience));
}

TEST(DiscoveryServer, AnyOfSeveralServersSuffices) {
  const std::string first = free_address();
  auto one = start_server(136, first);
  bus::ParticipantOptions a = client(136, "a", first);
  bus::ParticipantOptions b = client(136, "b", first);
  const std::string second = free_address();
  a.discovery_servers.push_back(second);  // never there
  b.discovery_servers.push_back(second);
  bus::Participant writing(a);
  bus::Participant reading(b);
  bus::Writer<ImuSample> writer(writing);
  Inbox<ImuSample> inbox;
  bus::Reader<ImuSample> reader(reading, inbox.handler());
  EXPECT_TRUE(eventually([&] { return writer.matched_readers() == 1; }, kPatience));
}

TEST(DiscoveryServer, WhatCannotBeIsRefusedInWords) {
  const auto refusal = [](const bus::ParticipantOptions& wanted) -> std::string {
    try {
      const bus::Participant participant(wanted);
    } catch (const bus::BusError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal(client(137, "a", "vehicle")),
            "discovery server 'vehicle': expected an IPv4 address and a port such as 192.168.2.1:11811");
  EXPECT_EQ(
      refusal(client(137, "a", "127.0.0.1:70000")),
      "discovery server '127.0.0.1:70000': expected an IPv4 address and a port such as 192.168.2.1:11811");
  EXPECT_EQ(refusal(server(137, "127.0.0.2:11811")),
            "discovery_listen '127.0.0.2:11811': expected one of the interfaces");
  bus::ParticipantOptions secure = client(137, "a", "127.0.0.1:11811");
  secure.security.folder = "credentials";
  EXPECT_EQ(refusal(secure),
            "discovery servers and security: expected only one of them, Fast DDS 2.9 aborts with both");
  const std::string address = free_address();
  const bus::Participant first(server(137, address));
  EXPECT_EQ(
      refusal(server(137, address)),
      "discovery_listen '" + address + "': Address already in use, expected a free UDP port of this host");
}

}  // namespace
}  // namespace fathom::test
