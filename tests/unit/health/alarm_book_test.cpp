#include "health/alarm_book.hpp"

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "health/text.hpp"
#include "timeline.hpp"

namespace fathom::health {
namespace {

Condition condition(const Name& key, Severity severity = Severity::warning, double value = 1.0) {
  return {.key = key, .severity = severity, .text = "It is so.", .value = value, .limit = 0.5};
}

TEST(AlarmBook, RaisedOnceHoweverOftenItIsHeld) {
  AlarmBook book("auv");
  for (int i = 0; i < 100; ++i) book.hold(condition("a", Severity::warning, 0.1 * i), at(0.1 * i));
  const auto transitions = book.take_transitions();
  ASSERT_EQ(transitions.size(), 1u);
  EXPECT_EQ(transitions[0].event, AlarmEvent::raised);
  EXPECT_TRUE(transitions[0].alarm.active);
  EXPECT_EQ(transitions[0].alarm.header.vehicle, Name("auv"));
  EXPECT_EQ(transitions[0].alarm.since_ns, at(0.0).utc_ns);
  EXPECT_NEAR(book.find("a")->value, 9.9, 0.01) << "text and value stay present";
  EXPECT_TRUE(book.take_transitions().empty());
}

TEST(AlarmBook, StaysUntilClearedAndAcknowledgedInEitherOrder) {
  AlarmBook book;
  book.hold(condition("a"), at(0.0));
  book.release("a", at(1.0));
  book.release("a", at(2.0));
  ASSERT_NE(book.find("a"), nullptr);
  EXPECT_FALSE(book.find("a")->active);
  EXPECT_EQ(book.find("a")->cleared_ns, at(2.0).utc_ns);
  EXPECT_EQ(book.unacknowledged_count(), 1u);
  EXPECT_EQ(book.acknowledge("a"), 1);
  EXPECT_EQ(book.find("a"), nullptr);

  book.hold(condition("b"), at(4.0));
  EXPECT_EQ(book.acknowledge("b"), 1);
  ASSERT_NE(book.find("b"), nullptr);
  EXPECT_TRUE(book.find("b")->active);
  EXPECT_EQ(book.acknowledge("b"), 0) << "once is enough";
  book.release("b", at(6.0));
  book.release("b", at(7.0));
  EXPECT_EQ(book.find("b"), nullptr);
  const auto transitions = book.take_transitions();
  ASSERT_FALSE(transitions.empty());
  EXPECT_EQ(transitions.back().event, AlarmEvent::cleared);
  EXPECT_FALSE(transitions.back().alarm.active);
  EXPECT_TRUE(transitions.back().alarm.acknowledged) << "readers are told of the end";
}

TEST(AlarmBook, FlickeringFasterThanTheHoldIsOneAlarm) {
  AlarmBook book;
  int raised = 0;
  int cleared = 0;
  for (int i = 0; i < 600; ++i) {
    const double t = 0.1 * i;
    if (i % 4 == 0) {
      book.hold(condition("a"), at(t));
    } else {
      book.release("a", at(t));
    }
    for (const AlarmTransition& one : book.take_transitions()) {
      raised += one.event == AlarmEvent::raised ? 1 : 0;
      cleared += one.event == AlarmEvent::cleared ? 1 : 0;
    }
  }
  EXPECT_EQ(raised, 1);
  EXPECT_EQ(cleared, 0);
}

TEST(AlarmBook, RaisedAgainItIsUnacknowledgedWithANewBeginning) {
  AlarmBook book;
  book.hold(condition("a", Severity::critical), at(0.0));
  book.release("a", at(1.0));
  book.release("a", at(2.0));
  book.hold(condition("a", Severity::warning), at(10.0));
  const Alarm* alarm = book.find("a");
  ASSERT_NE(alarm, nullptr);
  EXPECT_TRUE(alarm->active);
  EXPECT_FALSE(alarm->acknowledged);
  EXPECT_EQ(alarm->since_ns, at(10.0).utc_ns);
  EXPECT_EQ(alarm->cleared_ns, 0);
  EXPECT_EQ(alarm->severity, Severity::warning) << "a new occurrence starts with its own severity";
}

TEST(AlarmBook, SeverityOnlyRisesWhileActiveAndARiseWithdrawsTheAcknowledgement) {
  AlarmBook book;
  book.hold(condition("a", Severity::warning), at(0.0));
  book.acknowledge("*");
  book.hold(condition("a", Severity::notice), at(1.0));
  EXPECT_EQ(book.find("a")->severity, Severity::warning);
  EXPECT_TRUE(book.find("a")->acknowledged);
  book.hold(condition("a", Severity::critical), at(2.0));
  EXPECT_EQ(book.find("a")->severity, Severity::critical);
  EXPECT_FALSE(book.find("a")->acknowledged);
  EXPECT_EQ(book.find("a")->since_ns, at(0.0).utc_ns);
}

TEST(AlarmBook, EachTransitionIsRecordedOnceAsItHappened) {
  AlarmBook book;
  EXPECT_EQ(book.hold(condition("a", Severity::warning, 1.0), at(0.0)), AlarmEvent::raised);
  EXPECT_EQ(book.hold(condition("a", Severity::warning, 2.0), at(0.1)), std::nullopt) << "a new value alone";
  EXPECT_EQ(book.acknowledge("a"), 1);
  EXPECT_EQ(book.hold(condition("a", Severity::critical, 3.0), at(0.2)), AlarmEvent::worsened);
  EXPECT_EQ(book.release("a", at(1.0)), std::nullopt) << "it may be a flicker";
  EXPECT_EQ(book.release("a", at(2.0)), AlarmEvent::cleared);
  EXPECT_EQ(book.release("a", at(3.0)), std::nullopt) << "it is cleared already";
  EXPECT_EQ(book.acknowledge("a"), 1);
  EXPECT_EQ(book.release("a", at(4.0)), std::nullopt) << "it is no longer in the book";

  const auto transitions = book.take_transitions();
  ASSERT_EQ(transitions.size(), 5u);
  const auto expect = [&](std::size_t i, AlarmEvent event, Severity severity, bool active,
                          bool acknowledged) {
    EXPECT_EQ(transitions[i].event, event) << i;
    EXPECT_EQ(transitions[i].alarm.severity, severity) << i;
    EXPECT_EQ(transitions[i].alarm.active, active) << i;
    EXPECT_EQ(transitions[i].alarm.acknowledged, acknowledged) << i;
  };
  expect(0, AlarmEvent::raised, Severity::warning, true, false);
  expect(1, AlarmEvent::acknowledged, Severity::warning, true, true);
  expect(2, AlarmEvent::worsened, Severity::critical, true, false);
  expect(3, AlarmEvent::cleared, Severity::critical, false, false);
  expect(4, AlarmEvent::acknowledged, Severity::critical, false, true);
  EXPECT_TRUE(book.take_transitions().empty()) << "each is handed out once";
}

TEST(AlarmBook, StarAcknowledgesAll) {
  AlarmBook book;
  for (const char* key : {"a", "b", "c"}) book.hold(condition(key), at(0.0));
  EXPECT_EQ(book.acknowledge("no such alarm"), 0);
  EXPECT_EQ(book.acknowledge("*"), 3);
  EXPECT_EQ(book.unacknowledged_count(), 0u);
  EXPECT_EQ(book.active_count(), 3u);
}

TEST(AlarmBook, AnEventIsOverAtOnceAndStaysUntilAcknowledged) {
  AlarmBook book;
  book.event(condition("restarted", Severity::notice), at(1.0));
  ASSERT_NE(book.find("restarted"), nullptr);
  EXPECT_FALSE(book.find("restarted")->active);
  const auto transitions = book.take_transitions();
  ASSERT_EQ(transitions.size(), 2u);
  EXPECT_EQ(transitions[0].event, AlarmEvent::raised);
  EXPECT_TRUE(transitions[0].alarm.active);
  EXPECT_EQ(transitions[1].event, AlarmEvent::cleared);
  EXPECT_FALSE(transitions[1].alarm.active);
  EXPECT_EQ(book.acknowledge("restarted"), 1);
  EXPECT_EQ(book.find("restarted"), nullptr);
}

TEST(AlarmBook, IsBoundedAndLosesTheLeastImportantFirst) {
  AlarmBook book;
  book.hold(condition("cleared"), at(0.0));
  book.release("cleared", at(0.0));
  book.release("cleared", at(1.0));
  for (std::size_t i = 1; i < AlarmBook::kMaxAlarms; ++i) {
    book.hold(condition(Name("n" + std::to_string(i)), Severity::notice), at(1.0 + static_cast<double>(i)));
  }
  EXPECT_EQ(book.all().size(), AlarmBook::kMaxAlarms);
  EXPECT_EQ(book.dropped(), 0u);
  book.hold(condition("w"), at(100.0));
  EXPECT_EQ(book.find("cleared"), nullptr);
  book.hold(condition("x", Severity::critical), at(101.0));
  EXPECT_EQ(book.find("n1"), nullptr) << "the oldest notice went";
  book.hold(condition("one more notice", Severity::notice), at(102.0));
  EXPECT_EQ(book.find("one more notice"), nullptr) << "no room for what is no more important";
  EXPECT_EQ(book.all().size(), AlarmBook::kMaxAlarms);
  EXPECT_EQ(book.dropped(), 3u);
}

TEST(AlarmBook, ListsActiveFirstThenBySeverityThenByAge) {
  AlarmBook book;
  book.event(condition("over", Severity::critical), at(0.0));
  book.hold(condition("young"), at(2.0));
  book.hold(condition("old"), at(1.0));
  book.hold(condition("grave", Severity::critical), at(3.0));
  std::vector<std::string> order;
  for (const Alarm& alarm : book.all()) order.push_back(alarm.alarm.str());
  EXPECT_EQ(order, (std::vector<std::string>{"grave", "old", "young", "over"}));
  EXPECT_TRUE(book.any_active(Severity::critical));
}

TEST(AlarmText, KeysFitTheirFieldAndLongNamesStayApart) {
  EXPECT_EQ(alarm_key("service_missing", "fusion"), Name("service_missing:fusion"));
  EXPECT_EQ(alarm_key("service_missing", "actuator_bridge").view(), "service_missing:actuator_bridge");
  const Name one = alarm_key("service_missing", "guidance_example_one");
  const Name two = alarm_key("service_missing", "guidance_example_two");
  EXPECT_EQ(one.view().size(), Name::kCapacity);
  EXPECT_NE(one, two);
  EXPECT_EQ(one, alarm_key("service_missing", "guidance_example_one"));
}

TEST(AlarmText, DurationsReadAtAGlance) {
  EXPECT_EQ(duration_text(0.04), "0.0 s");
  EXPECT_EQ(duration_text(12.34), "12.3 s");
  EXPECT_EQ(duration_text(245.0), "4 min 05 s");
  EXPECT_EQ(duration_text(7380.0), "2 h 03 min");
  EXPECT_EQ(duration_text(kUnknown), "an unknown time");
}

TEST(AlarmBookRestored, StaysUntilAcknowledgedAndGivesWayToWhatHoldsNow) {
  AlarmBook book("auv");
  Alarm before;
  before.alarm = "gps_outage";
  before.active = true;
  before.severity = Severity::critical;
  before.since_ns = 7;
  book.restore(before, at(0.0), 10.0);
  ASSERT_NE(book.find("gps_outage"), nullptr);
  EXPECT_TRUE(book.find("gps_outage")->active) << "nothing is known against it";
  EXPECT_EQ(book.find("gps_outage")->since_ns, 7);
  EXPECT_EQ(book.unacknowledged_count(), 1u);
  const auto transitions = book.take_transitions();
  ASSERT_EQ(transitions.size(), 1u);
  EXPECT_EQ(transitions[0].event, AlarmEvent::restored);
  // A watcher that has heard nothing yet does not clear it; one that knows does.
  book.release("gps_outage", at(1.0));
  book.release("gps_outage", at(2.0));
  EXPECT_TRUE(book.find("gps_outage")->active);
  book.release("gps_outage", at(3.0), true);
  book.release("gps_outage", at(4.0), true);
  EXPECT_FALSE(book.find("gps_outage")->active);
  EXPECT_EQ(book.acknowledge("*"), 1);
  EXPECT_EQ(book.find("gps_outage"), nullptr);
}

TEST(AlarmBook, AnAlarmOfBeforeThatNothingConfirmsEndsInTime) {
  AlarmBook book("auv");
  Alarm before;
  before.alarm = "sensor_missing:sonar";
  before.active = true;
  book.restore(before, at(0.0), 10.0);
  book.settle(at(9.0));
  EXPECT_EQ(book.active_count(), 1u);
  book.settle(at(10.0));
  EXPECT_EQ(book.active_count(), 0u);
  EXPECT_EQ(book.unacknowledged_count(), 1u) << "latched until somebody has seen it";
  // One that was over stays over.
  AlarmBook other("auv");
  before.active = false;
  other.restore(before, at(0.0), 10.0);
  EXPECT_EQ(other.active_count(), 0u);
  EXPECT_EQ(other.unacknowledged_count(), 1u);
}

}  // namespace
}  // namespace fathom::health
