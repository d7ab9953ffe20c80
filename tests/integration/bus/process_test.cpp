// Several processes: services that die, come back, or stand by for each other.

#include <cstdlib>

#include "bus/writer.hpp"
#include "samples/imu.hpp"
#include "samples/nav_state.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

using bus::BusEventKind;
using std::chrono::steady_clock;

/// Body of a child: writes NavState at 100 Hz until stopped. The latitude is its ownership strength.
TEST(ChildProcess, DISABLED_WritesNavState) {
  bus::Participant participant(
      options(static_cast<std::uint32_t>(std::stoul(variable("TEST_DOMAIN"))), variable("TEST_NAME")));
  bus::WriterOptions writer_options;
  writer_options.ownership_strength = std::stoi(variable("TEST_STRENGTH"));
  bus::Writer<NavState> writer(participant, writer_options);
  NavState state;
  state.header.vehicle = "auv";
  state.latitude_rad = writer_options.ownership_strength;
  until_stopped(milliseconds(10), [&] {
    ++state.header.sequence;
    writer.write(state);
  });
}

Child nav_state_writer(std::uint32_t domain, const std::string& name, int strength) {
  return Child("ChildProcess.DISABLED_WritesNavState",
               {"TEST_DOMAIN=" + std::to_string(domain), "TEST_NAME=" + name,
                "TEST_STRENGTH=" + std::to_string(strength)});
}

TEST(Processes, AKilledWriterIsReportedAndMetAgainAfterRestart) {
  bus::Participant participant(options(115, "guidance"));
  const Events events(participant);
  Inbox<NavState> inbox;
  bus::Reader<NavState> reader(participant, inbox.handler());
  for (std::size_t round = 1; round <= 2; ++round) {
    const std::size_t before = inbox.size();
    Child fusion = nav_state_writer(115, "fusion", 1);
    ASSERT_TRUE(eventually([&] { return inbox.size() > before + 20; }));
    const auto killed = steady_clock::now();
    fusion.kill_hard();
    ASSERT_TRUE(eventually([&] { return participant.counters().writer_lost == round; }));
    EXPECT_LT(steady_clock::now() - killed, std::chrono::seconds(9));  // lease 6 s, and a loaded machine
    EXPECT_EQ(reader.matched_writers(), 0);
    ASSERT_EQ(events.of(BusEventKind::writer_lost).size(), round);
    EXPECT_EQ(events.of(BusEventKind::writer_lost).back().topic, "fathom/v1/nav_state");
    EXPECT_EQ(events.of(BusEventKind::writer_lost).back().detail,
              "writer of fusion fell silent and was given up");
  }
}

TEST(Processes, AWriterThatLeavesInOrderIsNotLost) {
  bus::Participant participant(options(116, "guidance"));
  Inbox<NavState> inbox;
  bus::Reader<NavState> reader(participant, inbox.handler());
  Child fusion = nav_state_writer(116, "fusion", 1);
  ASSERT_TRUE(eventually([&] { return inbox.size() > 5; }));
  EXPECT_EQ(fusion.stop(), 0);
  ASSERT_TRUE(eventually([&] { return reader.matched_writers() == 0; }, milliseconds(1500)));
  let_pass(milliseconds(6500));  // longer than the lease
  EXPECT_EQ(participant.counters().writer_lost, 0U);
  EXPECT_TRUE(participant.peers().empty());
}

TEST(Processes, TheStandbyTakesOverWhenTheStrongerIsKilled) {
  bus::Participant participant(options(117, "guidance"));
  Inbox<NavState> inbox;
  bus::Reader<NavState> reader(participant, inbox.handler());
  const auto last_strength = [&] {
    const auto all = inbox.all();
    return all.empty() ? -1.0 : all.back().first.latitude_rad;
  };
  Child standby = nav_state_writer(117, "standby", 1);
  ASSERT_TRUE(eventually([&] { return last_strength() == 1.0; }));
  Child primary = nav_state_writer(117, "primary", 9);
  ASSERT_TRUE(eventually([&] { return last_strength() == 9.0; }));
  ASSERT_TRUE(eventually([&] { return reader.matched_writers() == 2; }));
  const auto killed = steady_clock::now();
  primary.kill_hard();
  ASSERT_TRUE(eventually([&] { return last_strength() == 1.0; }));
  // By the deadline of 30 ms, not by the lease of 6 s; the rest is room for a loaded machine.
  EXPECT_LT(steady_clock::now() - killed, milliseconds(1000));
}

TEST(Processes, TwentyParticipantsFindEachOtherWithoutMulticast) {
  std::vector<std::unique_ptr<bus::Participant>> participants;
  for (int i = 0; i < 20; ++i) {
    participants.push_back(std::make_unique<bus::Participant>(options(118, "service" + std::to_string(i))));
  }
  for (const auto& participant : participants) {
    ASSERT_TRUE(eventually([&] { return participant->peers().size() == 19; })) << participant->peers().size();
  }
}

}  // namespace
}  // namespace fathom::test
