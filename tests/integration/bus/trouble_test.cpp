// What goes wrong on a network is counted, and reported once with names.

#include <algorithm>

#include <fastcdr/Cdr.h>

#include "bus/network_map.hpp"
#include "bus/writer.hpp"
#include "samples/dvl.hpp"
#include "samples/imu.hpp"
#include "samples/nav_state.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

using bus::BusEventKind;

TEST(Trouble, IncompatibleQosNamesTopicPolicyAndPeerOnBothSides) {
  bus::Participant a(options(110, "dvl_bridge"));
  bus::Participant b(options(110, "fusion"));
  const Events at_a(a);
  const Events at_b(b);
  bus::Writer<DvlSample> writer(a);  // promises no deadline
  bus::ReaderOptions demanding;
  demanding.deadline_ns = 500 * kNsPerMillisecond;
  const auto ignore = [](const DvlSample&, const bus::SampleInfo&) {};
  bus::Reader<DvlSample> reader(b, ignore, demanding);
  ASSERT_TRUE(eventually([&] {
    return !at_a.of(BusEventKind::incompatible_qos).empty() &&
           !at_b.of(BusEventKind::incompatible_qos).empty();
  }));
  // Fast DDS counts a pair twice when both learn of each other at the same instant: counts are compared.
  const std::uint64_t first_at_a = a.counters().incompatible_qos;
  const std::uint64_t first_at_b = b.counters().incompatible_qos;
  bus::Reader<DvlSample> same_again(b, ignore, demanding);
  ASSERT_TRUE(eventually([&] { return b.counters().incompatible_qos > first_at_b; }));
  ASSERT_TRUE(eventually([&] { return a.counters().incompatible_qos > first_at_a; }));

  ASSERT_EQ(at_b.of(BusEventKind::incompatible_qos).size(), 1U);
  const bus::BusEvent reader_side = at_b.of(BusEventKind::incompatible_qos)[0];
  EXPECT_EQ(reader_side.topic, "fathom/v1/dvl");
  EXPECT_EQ(reader_side.detail,
            "the writer of dvl_bridge offers another deadline than this reader requests (500 ms)");
  ASSERT_EQ(at_a.of(BusEventKind::incompatible_qos).size(), 1U);
  const bus::BusEvent writer_side = at_a.of(BusEventKind::incompatible_qos)[0];
  EXPECT_EQ(writer_side.topic, "fathom/v1/dvl");
  EXPECT_EQ(writer_side.detail,
            "the reader of fusion requests another deadline than this writer offers (none)");
  EXPECT_EQ(reader.matched_writers(), 0);
}

// The profile presumes an inertial unit of 100 Hz.
TEST(Trouble, AReaderWithoutADeadlineOfItsOwnFollowsAFusionThatPublishesLessOften) {
  for (const DurationNs offered_ns : {60 * kNsPerMillisecond, 300 * kNsPerMillisecond}) {
    bus::Participant a(options(110, "fusion"));
    bus::Participant b(options(110, "guidance"));
    const Events at_a(a);
    const Events at_b(b);
    bus::WriterOptions slow;
    slow.deadline_ns = offered_ns;
    bus::Writer<NavState> writer(a, slow);
    Inbox<NavState> inbox;
    bus::Reader<NavState> reader(b, inbox.handler());
    ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));
    EXPECT_TRUE(eventually([&] { return writer.write(NavState{}) && inbox.size() > 5; }));
    // Longer than a conflict waits to be reported.
    std::this_thread::sleep_for(milliseconds(2500));
    EXPECT_TRUE(at_a.of(BusEventKind::incompatible_qos).empty());
    EXPECT_TRUE(at_b.of(BusEventKind::incompatible_qos).empty());
  }
}

// Fast DDS tells of such a writer before it has returned the reader that is being made.
TEST(Trouble, AReaderThatFollowsAWriterItKnewLeavesNoOtherBehind) {
  bus::Participant a(options(110, "fusion"));
  bus::Participant b(options(110, "guidance"));
  bus::WriterOptions slow;
  slow.deadline_ns = 60 * kNsPerMillisecond;
  const bus::Writer<NavState> writer(a, slow);
  ASSERT_TRUE(eventually([&] { return !bus::endpoints(b).empty(); }));
  const auto readers = [&] {
    const auto known = bus::endpoints(a);
    return std::count_if(known.begin(), known.end(), [](const auto& one) { return !one.writes; });
  };
  for (int i = 0; i < 40; ++i) {
    {
      const bus::Reader<NavState> reader(b, [](const NavState&, const bus::SampleInfo&) {});
      ASSERT_TRUE(eventually([&] { return reader.matched_writers() == 1 && writer.matched_readers() == 1; }));
      ASSERT_TRUE(eventually([&] { return readers() == 1; })) << "at the reader " << i;
    }
    ASSERT_TRUE(eventually([&] { return readers() == 0; })) << "after the reader " << i;
  }
}

TEST(Trouble, AWriterThatPromisesNothingIsNotFollowed) {
  bus::Participant a(options(110, "stranger"));
  bus::Participant b(options(110, "guidance"));
  const Events at_b(b);
  bus::WriterOptions never;
  never.deadline_ns = 3600 * kNsPerSecond;
  bus::Writer<NavState> writer(a, never);
  bus::Reader<NavState> reader(b, [](const NavState&, const bus::SampleInfo&) {});
  ASSERT_TRUE(eventually([&] { return !at_b.of(BusEventKind::incompatible_qos).empty(); }));
  EXPECT_EQ(at_b.of(BusEventKind::incompatible_qos)[0].detail,
            "the writer of stranger offers another deadline than this reader requests (30 ms)");
  EXPECT_EQ(reader.matched_writers(), 0);
}

TEST(Trouble, AnotherTypeOnATopicIsReported) {
  bus::Participant a(options(111, "stranger"));
  bus::Participant b(options(111, "fusion"));
  const Events at_b(b);
  bus::Reader<ImuSample> reader(b, [](const ImuSample&, const bus::SampleInfo&) {});
  bus::detail::TopicOps other = bus::detail::topic_ops<ImuSample>();
  other.type_name = "fathom::v2::ImuSample";
  bus::detail::WriterCore writer(a, other, {});
  ASSERT_TRUE(eventually([&] { return !at_b.of(BusEventKind::incompatible_qos).empty(); }));
  EXPECT_EQ(
      at_b.of(BusEventKind::incompatible_qos)[0].detail,
      "type 'fathom::v2::ImuSample' of stranger differs from ours, 'fathom::v1::ImuSample': they never meet");
}

TEST(Trouble, BytesThatAreNoSampleAreCountedAndDoNoHarm) {
  bus::Participant a(options(112, "stranger"));
  bus::Participant b(options(112, "fusion"));
  const Events at_b(b);
  Inbox<DvlSample> inbox;
  bus::Reader<DvlSample> reader(b, inbox.handler());
  bus::detail::TopicOps broken = bus::detail::topic_ops<DvlSample>();
  broken.encode = [](const void*, eprosima::fastcdr::Cdr& cdr) { cdr << 0xFFFFFFFFU << 0xFFFFFFFFU; };
  bus::detail::WriterCore stranger(a, broken, {});
  ASSERT_TRUE(eventually([&] { return stranger.matched_readers() == 1 && reader.matched_writers() == 1; }));
  const DvlSample sample;
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(stranger.write(&sample));
  ASSERT_TRUE(eventually([&] { return b.counters().invalid_sample == 5; }));
  ASSERT_EQ(at_b.of(BusEventKind::invalid_sample).size(), 1U);
  EXPECT_EQ(at_b.of(BusEventKind::invalid_sample)[0].detail,
            "stranger sent bytes that are no fathom::v1::DvlSample");

  bus::Participant c(options(112, "dvl_bridge"));
  bus::Writer<DvlSample> honest(c);
  ASSERT_TRUE(eventually([&] { return reader.matched_writers() == 2 && honest.matched_readers() == 1; }));
  EXPECT_TRUE(honest.write(sample));
  EXPECT_TRUE(eventually([&] { return inbox.size() == 1; }));
}

TEST(Trouble, MissedDeadlinesAreCountedAndReportedOnceWhileTheyFlicker) {
  bus::Participant a(options(113, "imu_bridge"));
  bus::Participant b(options(113, "fusion"));
  const Events at_a(a);
  const Events at_b(b);
  bus::WriterOptions offered;
  offered.deadline_ns = 100 * kNsPerMillisecond;
  bus::ReaderOptions requested;
  requested.deadline_ns = 100 * kNsPerMillisecond;
  bus::Writer<ImuSample> writer(a, offered);
  bus::Reader<ImuSample> reader(
      b, [](const ImuSample&, const bus::SampleInfo&) {}, requested);
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));
  ImuSample sample;
  sample.header.vehicle = "auv";
  sample.header.sensor = "imu0";
  ASSERT_TRUE(writer.write(sample));
  ASSERT_TRUE(
      eventually([&] { return b.counters().deadline_missed >= 3 && a.counters().deadline_missed >= 3; }));
  ASSERT_EQ(at_b.of(BusEventKind::deadline_missed).size(), 1U);
  EXPECT_EQ(at_b.of(BusEventKind::deadline_missed)[0].topic, "fathom/v1/imu");
  EXPECT_EQ(at_b.of(BusEventKind::deadline_missed)[0].detail,
            "imu_bridge sent nothing about auv/imu0 for 100 ms");
  ASSERT_EQ(at_a.of(BusEventKind::deadline_missed).size(), 1U);
  EXPECT_EQ(at_a.of(BusEventKind::deadline_missed)[0].detail,
            "this service wrote nothing about auv/imu0 for 100 ms");

  const std::uint64_t before_a = a.counters().deadline_missed;
  const std::uint64_t before_b = b.counters().deadline_missed;
  ASSERT_TRUE(writer.write(sample));  // recovers, then is silent again: still the same trouble
  EXPECT_TRUE(eventually([&] {
    return b.counters().deadline_missed >= before_b + 3 && a.counters().deadline_missed >= before_a + 3;
  }));
  EXPECT_EQ(at_b.of(BusEventKind::deadline_missed).size(), 1U);
  EXPECT_EQ(at_a.of(BusEventKind::deadline_missed).size(), 1U);
}

}  // namespace
}  // namespace fathom::test
