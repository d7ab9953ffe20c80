// The books of events and peers, and the comparison of QoS: everything of the bus that needs no network.

#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/detail/event_book.hpp"
#include "bus/detail/key_deadlines.hpp"
#include "bus/detail/network/peer_book.hpp"
#include "unit/bus/bodies.hpp"

namespace fathom::bus::detail {
namespace {

TEST(EventBook, ReportsTheFirstOfEachSubjectAndCountsAll) {
  EventBook book;
  std::vector<BusEvent> seen;
  book.set_handler([&](const BusEvent& event) { seen.push_back(event); });
  book.report(BusEventKind::deadline_missed, "t", "a", "first", 2);
  book.report(BusEventKind::deadline_missed, "t", "a", "again", 3);
  book.report(BusEventKind::deadline_missed, "t", "b", "other subject");
  book.report(BusEventKind::deadline_missed, "u", "a", "other topic");
  book.report(BusEventKind::writer_lost, "t", "a", "other kind");
  ASSERT_EQ(seen.size(), 4U);
  EXPECT_EQ(seen[0].detail, "first");
  EXPECT_EQ(seen[0].topic, "t");
  EXPECT_EQ(seen[3].kind, BusEventKind::writer_lost);
  EXPECT_EQ(book.counters().deadline_missed, 7U);
  EXPECT_EQ(book.counters().writer_lost, 1U);
}

TEST(EventBook, ReportsAgainAfterRecovery) {
  EventBook book;
  int reports = 0;
  book.set_handler([&](const BusEvent&) { ++reports; });
  book.report(BusEventKind::writer_lost, "t", "a", "");
  book.recovered(BusEventKind::writer_lost, "t", "b");
  book.report(BusEventKind::writer_lost, "t", "a", "");
  EXPECT_EQ(reports, 1);
  book.recovered(BusEventKind::writer_lost, "t", "a");
  book.report(BusEventKind::writer_lost, "t", "a", "");
  EXPECT_EQ(reports, 2);
}

TEST(EventBook, FlickeringDeadlineIsReportedOnceAndAgainAfterAQuietTime) {
  TimeNs now = 0;
  EventBook book(10 * kNsPerSecond, [&now] { return now; });
  int reports = 0;
  book.set_handler([&](const BusEvent&) { ++reports; });
  for (int i = 0; i < 100; ++i) {
    book.report(BusEventKind::deadline_missed, "t", "a", "");
    now += kNsPerSecond / 10;
    book.recovered(BusEventKind::deadline_missed, "t", "a");
    now += 5 * kNsPerSecond;
  }
  EXPECT_EQ(reports, 1);
  now += 10 * kNsPerSecond;
  book.report(BusEventKind::deadline_missed, "t", "a", "");
  EXPECT_EQ(reports, 2);
  EXPECT_EQ(book.counters().deadline_missed, 101U);
}

TEST(EventBook, DeliversWhatHappenedBeforeTheHandlerWasSet) {
  EventBook book;
  for (int i = 0; i < 100; ++i) book.report(BusEventKind::sample_lost, "t", std::to_string(i), "");
  int reports = 0;
  book.set_handler([&](const BusEvent&) { ++reports; });
  EXPECT_EQ(reports, 64);
  book.set_handler(nullptr);
  book.set_handler([&](const BusEvent&) { ++reports; });
  EXPECT_EQ(reports, 64);
}

TEST(EventBook, TooManySubjectsAreCountedAndThatIsSaidOnce) {
  EventBook book;
  std::vector<BusEvent> seen;
  book.set_handler([&](const BusEvent& event) { seen.push_back(event); });
  constexpr std::size_t kMost = EventBook::kMostOfAKind;
  const auto subject = [](std::size_t i) { return "p" + std::to_string(i); };
  for (std::size_t i = 0; i < 4 * kMost; ++i) book.report(BusEventKind::writer_lost, "t", subject(i), "lost");
  ASSERT_EQ(seen.size(), kMost + 1);
  EXPECT_EQ(seen.back().detail, "there are more than 256 of them: further ones are counted and not told");
  EXPECT_EQ(book.counters().writer_lost, 4 * kMost);
  book.report(BusEventKind::sample_lost, "t", "a", "of another kind");
  EXPECT_EQ(seen.size(), kMost + 2);
  // What is over gives way to what is new.
  book.recovered(BusEventKind::writer_lost, "t", subject(7));
  book.report(BusEventKind::writer_lost, "t", "new", "told");
  ASSERT_EQ(seen.size(), kMost + 3);
  EXPECT_EQ(seen.back().detail, "told");
  book.report(BusEventKind::writer_lost, "t", "newer", "not told");
  EXPECT_EQ(seen.size(), kMost + 3);
}

TEST(EventBook, CountsEachKindByItself) {
  EventBook book;
  book.report(BusEventKind::incompatible_qos, "t", "", "", 1);
  book.report(BusEventKind::deadline_missed, "t", "", "", 2);
  book.report(BusEventKind::writer_lost, "t", "", "", 3);
  book.report(BusEventKind::sample_lost, "t", "", "", 4);
  book.report(BusEventKind::write_failed, "t", "", "", 5);
  book.report(BusEventKind::resource_limit, "t", "", "", 6);
  book.report(BusEventKind::invalid_sample, "t", "", "", 7);
  book.report(BusEventKind::stranger_refused, "", "", "", 8);
  book.report(BusEventKind::permission_refused, "t", "", "", 9);
  book.report(BusEventKind::malformed_datagram, "", "", "", 10);
  const BusCounters counters = book.counters();
  EXPECT_EQ(counters.incompatible_qos, 1U);
  EXPECT_EQ(counters.deadline_missed, 2U);
  EXPECT_EQ(counters.writer_lost, 3U);
  EXPECT_EQ(counters.sample_lost, 4U);
  EXPECT_EQ(counters.write_failed, 5U);
  EXPECT_EQ(counters.resource_limit, 6U);
  EXPECT_EQ(counters.invalid_sample, 7U);
  EXPECT_EQ(counters.stranger_refused, 8U);
  EXPECT_EQ(counters.permission_refused, 9U);
  EXPECT_EQ(counters.malformed_datagram, 10U);
}

TEST(PeerBook, NamesTheParticipantOfAWriterAlsoAfterItLeft) {
  PeerBook book;
  EXPECT_EQ(book.name(guid(0xAB, 3)), "ab000000000000000000000000000003");
  EXPECT_FALSE(book.peer(guid(0xAB, 3)).has_value());
  book.participant_seen(prefix_of(guid(0xAB, 0)), {"fusion", "host", 12});
  EXPECT_EQ(book.name(guid(0xAB, 3)), "fusion");
  EXPECT_EQ(book.peer(guid(0xAB, 3))->pid, 12U);
  EXPECT_EQ(book.present().size(), 1U);
  book.participant_gone(prefix_of(guid(0xAB, 0)));
  EXPECT_EQ(book.name(guid(0xAB, 3)), "fusion");
  EXPECT_TRUE(book.present().empty());
}

TEST(PeerBook, ForgetsTheOldestOfManyThatLeft) {
  PeerBook book;
  for (int i = 0; i < 300; ++i) {
    WriterGuid id{};
    id[0] = static_cast<std::uint8_t>(i);
    id[1] = static_cast<std::uint8_t>(i / 256);
    book.participant_seen(prefix_of(id), {"p" + std::to_string(i), "", 0});
    book.participant_gone(prefix_of(id));
  }
  EXPECT_FALSE(book.peer(guid(0, 0)).has_value());
  WriterGuid last{};
  last[0] = static_cast<std::uint8_t>(299 - 256);
  last[1] = 1;
  EXPECT_TRUE(book.peer(last).has_value());
}

TEST(PeerBook, NamesWhoIsInConflict) {
  PeerBook book;
  book.participant_seen(prefix_of(guid(1, 0)), {"one", "", 0});
  book.participant_seen(prefix_of(guid(2, 0)), {"two", "", 0});
  QosSummary fast;
  fast.deadline_ns = 10 * kNsPerMillisecond;
  QosSummary slow;
  slow.deadline_ns = kNsPerSecond;
  book.writer_seen(guid(1, 1), {"t", "T", fast});
  book.writer_seen(guid(2, 1), {"t", "T", slow});
  QosSummary requested;
  requested.deadline_ns = 100 * kNsPerMillisecond;
  EXPECT_EQ(book.writers_in_conflict("t", Policy::deadline, requested), (std::set<std::string>{"two"}));
  EXPECT_EQ(book.writers_in_conflict("t", Policy::reliability, requested), (std::set<std::string>{}));
  EXPECT_EQ(book.writers_in_conflict("u", Policy::deadline, requested), (std::set<std::string>{}));
  EXPECT_EQ(book.longest_deadline("t", 10 * kNsPerSecond), kNsPerSecond);
  EXPECT_EQ(book.longest_deadline("t", 100 * kNsPerMillisecond), 10 * kNsPerMillisecond);
  EXPECT_EQ(book.longest_deadline("u", 10 * kNsPerSecond), 0);
  book.reader_seen(guid(1, 2), {"t", "Other", fast});
  EXPECT_EQ(book.readers_in_conflict("t", Policy::deadline, requested), (std::set<std::string>{"one"}));
  EXPECT_EQ(book.type_conflicts("t", "T"), (std::vector<std::string>{"type 'Other' of one"}));
  book.writer_gone(guid(2, 1));
  EXPECT_EQ(book.writers_in_conflict("t", Policy::deadline, requested), (std::set<std::string>{}));
}

TEST(KeyDeadlines, TellOnceThatAKeyRecovered) {
  KeyDeadlines<int> deadlines;
  const WriterGuid left{1};
  const WriterGuid right{2};
  const auto text = [] { return std::string("left"); };
  const auto owes = [](const WriterGuid&) { return true; };
  EXPECT_FALSE(deadlines.missed(7, owes)) << "nothing was ever heard of it";
  EXPECT_FALSE(deadlines.heard(7, left, text));
  EXPECT_FALSE(deadlines.heard(7, right, [] { return std::string("asked for once"); }));
  const auto missed = deadlines.missed(7, owes);
  ASSERT_TRUE(missed);
  EXPECT_EQ(missed->text, "left");
  EXPECT_EQ(missed->writer, right);
  EXPECT_EQ(deadlines.heard(7, right, text), "left");
  EXPECT_FALSE(deadlines.heard(7, right, text));
}

TEST(KeyDeadlines, AreNotMissedByAWriterThatLeft) {
  KeyDeadlines<int> deadlines;
  const WriterGuid left{1};
  const auto text = [] { return std::string("depth"); };
  EXPECT_FALSE(deadlines.heard(7, left, text));
  EXPECT_FALSE(deadlines.missed(7, [&](const WriterGuid& writer) { return writer != left; }));
  EXPECT_FALSE(deadlines.heard(7, left, text)) << "what was not missed did not recover";
}

TEST(Qos, ConflictsAsTheStandardSays) {
  const QosSummary plain;
  const auto with = [](auto change) {
    QosSummary qos;
    change(qos);
    return qos;
  };
  struct Case {
    Policy policy;
    QosSummary more;
  };
  const std::vector<Case> cases{
      {Policy::reliability, with([](auto& q) { q.reliability = 1; })},
      {Policy::durability, with([](auto& q) { q.durability = 1; })},
      {Policy::deadline, with([](auto& q) { q.deadline_ns = 5; })},
      {Policy::liveliness, with([](auto& q) { q.liveliness = 2; })},
      {Policy::liveliness, with([](auto& q) { q.lease_ns = 5; })},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(to_string(c.policy));
    EXPECT_TRUE(conflict(c.policy, plain, c.more));   // offered less than requested
    EXPECT_FALSE(conflict(c.policy, c.more, plain));  // offered more
    EXPECT_FALSE(conflict(c.policy, c.more, c.more));
    EXPECT_FALSE(conflict(Policy::other, plain, c.more));
  }
  QosSummary exclusive;
  exclusive.ownership = 1;
  EXPECT_TRUE(conflict(Policy::ownership, plain, exclusive));
  EXPECT_TRUE(conflict(Policy::ownership, exclusive, plain));
  EXPECT_EQ(value_text(Policy::ownership, exclusive), "exclusive");
  EXPECT_EQ(duration_text(30 * kNsPerMillisecond), "30 ms");
  EXPECT_EQ(duration_text(1'500'000'000), "1.5 s");
  EXPECT_EQ(duration_text(kForever), "none");
}

}  // namespace
}  // namespace fathom::bus::detail
