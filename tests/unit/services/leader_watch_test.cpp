#include "fusion/replica/leader_watch.hpp"

#include <gtest/gtest.h>

namespace fathom::fusion {
namespace {

WriterGuid writer_of(std::uint8_t participant, std::uint8_t entity) {
  WriterGuid out{};
  out[3] = participant;
  out[15] = entity;
  return out;
}

ReplicaStatus account(const Name& instance, bool leads) {
  ReplicaStatus out;
  out.header.sensor = instance;
  out.leads = leads;
  return out;
}

constexpr DurationNs kPatience_ns = kNsPerSecond;

class LeaderWatchTest : public ::testing::Test {
 protected:
  /// Instance a, participant 1, leads and is heard.
  void a_leads(TimeNs now_ns) {
    watch.heard("a", writer_of(1, 1), now_ns);
    watch.told(account("a", true), writer_of(1, 2), now_ns);
  }
  [[nodiscard]] std::string why(const Name& instance, std::uint8_t participant, TimeNs now_ns = 0) const {
    return watch.objection(instance, writer_of(participant, 3), now_ns).why;
  }
  [[nodiscard]] bool forged(const Name& instance, std::uint8_t participant, TimeNs now_ns = 0) const {
    return watch.objection(instance, writer_of(participant, 3), now_ns).forged;
  }
  LeaderWatch watch{kPatience_ns};
};

TEST_F(LeaderWatchTest, AStateIsTakenFromTheLeaderOnly) {
  EXPECT_EQ(why("a", 1), "comes while nobody is heard to lead");
  a_leads(0);
  EXPECT_EQ(why("a", 1), "");
  EXPECT_EQ(why("b", 2), "is not that of a, which leads");
  EXPECT_TRUE(forged("b", 2));
}

TEST_F(LeaderWatchTest, ANameIsNotEnough) {
  a_leads(0);
  EXPECT_EQ(why("a", 9), "comes from another participant than the a that is heard to lead");
  EXPECT_TRUE(forged("a", 9));
  watch.told(account("a", true), writer_of(9, 2), 0);  // a stranger says that it is the leader
  EXPECT_NE(why("a", 9), "");
  EXPECT_EQ(why("a", 1), "") << "and takes nothing from the leader by it";
  for (int i = 1; i <= 4; ++i) {
    a_leads(i * kPatience_ns);
    watch.told(account("a", true), writer_of(9, 2), i * kPatience_ns);
  }
  EXPECT_TRUE(forged("a", 9, 4 * kPatience_ns)) << "who leads for so long would be heard";
}

TEST_F(LeaderWatchTest, OneThatFellSilentIsNotTheLeader) {
  a_leads(0);
  EXPECT_NE(why("a", 1, kPatience_ns + 1), "");
  watch.heard("a", writer_of(1, 1), 2 * kPatience_ns);
  EXPECT_NE(why("a", 1, 2 * kPatience_ns), "") << "its account is old";
  EXPECT_FALSE(forged("a", 1, 2 * kPatience_ns));
  watch.told(account("a", false), writer_of(1, 2), 2 * kPatience_ns);
  EXPECT_NE(why("a", 1, 2 * kPatience_ns), "");
  a_leads(2 * kPatience_ns);
  EXPECT_EQ(why("a", 1, 2 * kPatience_ns), "");
}

TEST_F(LeaderWatchTest, AChangeOfLeadershipIsNoForgery) {
  a_leads(0);
  // b takes over: its account is here before its state, that of a is still under way.
  watch.told(account("b", true), writer_of(2, 2), 10);
  EXPECT_NE(why("b", 2, 10), "");
  EXPECT_FALSE(forged("b", 2, 10));
  watch.heard("b", writer_of(2, 1), 20);
  watch.told(account("a", false), writer_of(1, 2), 20);
  EXPECT_EQ(why("b", 2, 20), "");
  EXPECT_NE(why("a", 1, 20), "");
  EXPECT_FALSE(forged("a", 1, 20));
}

TEST_F(LeaderWatchTest, StrangersFillNoMemory) {
  for (int i = 0; i < 200; ++i) watch.told(account("x", true), writer_of(static_cast<std::uint8_t>(i), 2), 0);
  watch.heard("a", writer_of(250, 1), 2 * kPatience_ns);
  watch.told(account("a", true), writer_of(250, 2), 2 * kPatience_ns);
  EXPECT_EQ(why("a", 250, 2 * kPatience_ns), "");
}

}  // namespace
}  // namespace fathom::fusion
