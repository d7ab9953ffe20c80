// Strangers and missing permissions, as services count them and as the monitor sees them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "health/writers/intruder_watch.hpp"
#include "timeline.hpp"

namespace fathom::health {
namespace {

using testing::HasSubstr;

class Intruders : public testing::Test {
 protected:
  void life(const Name& service, double seconds, std::uint64_t strangers, std::uint64_t denied = 0,
            std::uint32_t pid = 100, std::uint64_t malformed = 0) {
    ServiceStatus status = life_sign(service, seconds, ServiceState::healthy, pid);
    status.counters = {{"other", 7},
                       {"bus_stranger_refused", strangers},
                       {"bus_permission_refused", denied},
                       {"bus_malformed_datagram", malformed}};
    watch.add(status, at(seconds));
  }
  const Alarm* alarm(const Name& key, double seconds) {
    watch.report(book, at(seconds));
    return book.find(key);
  }
  bool active(const Name& key, double seconds) {
    const Alarm* found = alarm(key, seconds);
    return found != nullptr && found->active;
  }

  IntruderWatch watch;
  AlarmBook book{"auv"};
};

TEST_F(Intruders, NobodyIsNoAlarm) {
  for (int second = 0; second < 60; ++second) life("fusion", second, 0);
  EXPECT_EQ(alarm("stranger_refused", 60), nullptr);
  EXPECT_EQ(alarm("permission_refused", 60), nullptr);
  EXPECT_EQ(alarm("malformed_datagram", 60), nullptr);
}

TEST_F(Intruders, DatagramsThatWouldEndAServiceAreAnAlarm) {
  life("fusion", 0, 0, 0, 100, 1);
  ASSERT_TRUE(active("malformed_datagram", 0));
  EXPECT_EQ(book.find("malformed_datagram")->severity, Severity::warning);
  EXPECT_THAT(book.find("malformed_datagram")->text, HasSubstr("counted by fusion,"));
  EXPECT_EQ(alarm("stranger_refused", 0), nullptr);
}

TEST_F(Intruders, AStateThatIsNotTheLeadersIsAnAlarm) {
  ServiceStatus status = life_sign("fusion_b", 0, ServiceState::healthy, 100);
  status.counters = {{"state_refused", 0}};
  watch.add(status, at(0));
  EXPECT_EQ(alarm("state_refused", 0), nullptr);
  status.counters = {{"state_refused", 3}};
  watch.add(status, at(1));
  ASSERT_TRUE(active("state_refused", 1));
  EXPECT_EQ(book.find("state_refused")->severity, Severity::warning);
  EXPECT_THAT(book.find("state_refused")->text, HasSubstr("counted by fusion_b,"));
}

TEST_F(Intruders, ACountThatGrowsIsAnAlarmThatStaysUntilAcknowledged) {
  life("fusion", 0, 0);
  life("monitor", 0, 0);
  EXPECT_FALSE(active("stranger_refused", 0));
  life("fusion", 1, 1);
  ASSERT_TRUE(active("stranger_refused", 1));
  EXPECT_EQ(book.find("stranger_refused")->severity, Severity::warning);
  EXPECT_EQ(book.find("stranger_refused")->text,
            "The network refuses somebody who proved no identity; counted by fusion.");
  for (int second = 2; second < 30; ++second) life("fusion", second, 1);
  EXPECT_TRUE(active("stranger_refused", 30));
  EXPECT_TRUE(active("stranger_refused", 31.1));  // a flicker would be the same alarm
  EXPECT_FALSE(active("stranger_refused", 32));
  ASSERT_NE(book.find("stranger_refused"), nullptr);
  EXPECT_EQ(book.acknowledge("*"), 1);
  EXPECT_EQ(book.find("stranger_refused"), nullptr);
  EXPECT_EQ(alarm("permission_refused", 33), nullptr);
}

TEST_F(Intruders, WhatAServiceCountedBeforeItWasHeardCounts) {
  life("fusion", 0, 3);
  EXPECT_TRUE(active("stranger_refused", 0));
}

TEST_F(Intruders, ARestartedServiceCountsFromZero) {
  life("fusion", 0, 5);
  ASSERT_TRUE(active("stranger_refused", 0));
  life("fusion", 40, 0, 0, 200);
  EXPECT_FALSE(active("stranger_refused", 41) && active("stranger_refused", 42));
  life("fusion", 50, 1, 0, 200);
  EXPECT_TRUE(active("stranger_refused", 50));
}

TEST_F(Intruders, TheAlarmNamesWhoIsThereAndLastsAsLong) {
  watch.strangers({"'evil' (GUID 010f) offers no identity", "another"}, at(0));
  ASSERT_TRUE(active("stranger_refused", 0));
  EXPECT_EQ(book.find("stranger_refused")->text,
            "The network refuses 'evil' (GUID 010f) offers no identity, and 1 more.");
  EXPECT_TRUE(active("stranger_refused", 1000));
  watch.strangers({}, at(1001));
  EXPECT_FALSE(active("stranger_refused", 1001) && active("stranger_refused", 1002));
}

TEST_F(Intruders, AnIdentityBeyondItsPermissionIsAnAlarmOfItsOwn) {
  for (const char* service : {"a", "b", "c", "d"}) life(service, 0, 0, 2);
  ASSERT_TRUE(active("permission_refused", 0));
  EXPECT_THAT(book.find("permission_refused")->text, HasSubstr("counted by a, b, c and 1 more"));
  EXPECT_EQ(alarm("stranger_refused", 0), nullptr);
}

}  // namespace
}  // namespace fathom::health
