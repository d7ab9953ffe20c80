// What readers get of what writers write.

#include <atomic>
#include <future>
#include <set>
#include <type_traits>

#include <sched.h>

#include "bus/writer.hpp"
#include "samples/command.hpp"
#include "samples/gps.hpp"
#include "samples/imu.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/verdict.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

TEST(Delivery, EverySampleInOrderWithItsOrigin) {
  bus::Participant a(options(102, "imu_bridge"));
  bus::Participant b(options(102, "fusion"));
  Inbox<ImuSample> inbox;
  bus::Writer<ImuSample> writer(a);
  bus::Reader<ImuSample> reader(b, inbox.handler());
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));

  ImuSample sample;
  sample.header.vehicle = "auv";
  sample.header.sensor = "imu0";
  for (std::uint64_t i = 1; i <= 1500; ++i) {  // back to back: less than the history holds
    sample.header.sequence = i;
    ASSERT_TRUE(writer.write(sample));
  }
  ASSERT_TRUE(eventually([&] { return inbox.size() == 1500; })) << inbox.size();
  std::uint64_t expected = 1;
  for (const auto& [got, info] : inbox.all()) {
    ASSERT_EQ(got.header.sequence, expected++);
    EXPECT_EQ(b.writer_name(info.writer_guid), "imu_bridge");
    EXPECT_GT(info.source_ns, 1'600'000'000 * kNsPerSecond);
    EXPECT_GE(info.reception_ns, info.source_ns);
  }
  const auto peer = b.peer(inbox.all().front().second.writer_guid);
  ASSERT_TRUE(peer.has_value());
  EXPECT_FALSE(peer->host.empty());
  EXPECT_EQ(peer->pid, static_cast<std::uint32_t>(getpid()));
  EXPECT_EQ(b.counters().sample_lost, 0U);
}

template <class T>
class Successors : public testing::Test {};
using OfBothOwnerships = testing::Types<ImuSample, NavState>;  // shared, exclusive
TYPED_TEST_SUITE(Successors, OfBothOwnerships);

TYPED_TEST(Successors, GoOnInOrderWithoutASampleLostOrTwice) {
  bus::Participant a(options(102, "fusion"));
  bus::Participant b(options(102, "guidance"));
  bus::Participant c(options(102, "monitor"));
  Events events(b);
  Inbox<TypeParam> inbox;
  Inbox<TypeParam> other;
  bus::WriterOptions with;
  with.successor_after = 500;
  bus::Writer<TypeParam> writer(a, with);
  bus::ReaderOptions each_one;
  each_one.profile_suffix = "deep";
  bus::Reader<TypeParam> reader(b, inbox.handler(), each_one);
  const bus::Reader<TypeParam> another(c, other.handler(), each_one);
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 2 && reader.matched_writers() == 1; }));

  TypeParam sample;
  sample.header.vehicle = "auv";
  const WriterGuid first = writer.guid();
  std::set<WriterGuid> writers;
  EXPECT_TRUE(eventually(
      [&] {
        ++sample.header.sequence;
        EXPECT_TRUE(writer.write(sample));
        writers.insert(writer.guid());
        return writers.size() == 3;
      },
      std::chrono::seconds(60)));
  EXPECT_EQ(writer.matched_readers(), 2);
  for (const Inbox<TypeParam>* one : {&inbox, &other}) {
    const auto newest = [&] { return one->all().back().first.header.sequence; };
    ASSERT_TRUE(eventually([&] { return newest() == sample.header.sequence; }));
    std::uint64_t before = 0;
    for (const auto& [got, info] : one->all()) {
      ASSERT_GT(got.header.sequence, before);
      before = got.header.sequence;
    }
    EXPECT_EQ(one->size(), sample.header.sequence);
    EXPECT_EQ(one->all().front().second.writer_guid, first);
    EXPECT_NE(one->all().back().second.writer_guid, first);
  }
  EXPECT_TRUE(eventually([&] { return reader.matched_writers() == 1; }));
  EXPECT_TRUE(events.of(bus::BusEventKind::writer_lost).empty());
  EXPECT_TRUE(events.of(bus::BusEventKind::sample_lost).empty());
}

TEST(Successor, IsNotOfAWriterThatKeepsSamplesForLateReaders) {
  bus::Participant a(options(102, "fusion"));
  bus::WriterOptions with;
  with.successor_after = 1;
  bus::Writer<ServiceStatus> writer(a, with);
  const WriterGuid first = writer.guid();
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(writer.write(ServiceStatus{}));
  let_pass(milliseconds(3500));
  EXPECT_EQ(writer.guid(), first);
}

TEST(Successor, OfAnExclusiveTopicIsHeardAlsoWhenTheIdentitiesBeginAnew) {
  bus::Participant a(options(102, "fusion"));
  bus::Participant b(options(102, "guidance"));
  for (int i = 0; i < 378; ++i) {  // of 379
    const bus::Writer<NavState> uses_one(a);
  }
  Inbox<NavState> inbox;
  bus::WriterOptions with;
  with.successor_after = 100;
  bus::Writer<NavState> writer(a, with);
  bus::ReaderOptions each_one;
  each_one.profile_suffix = "deep";
  bus::Reader<NavState> reader(b, inbox.handler(), each_one);
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));
  NavState sample;
  sample.header.vehicle = "auv";
  const WriterGuid first = writer.guid();
  const auto write = [&] {
    ++sample.header.sequence;
    EXPECT_TRUE(writer.write(sample));
    return writer.guid() != first;
  };
  ASSERT_TRUE(eventually(write, std::chrono::seconds(60)));
  EXPECT_LT(first, writer.guid());
  for (int i = 0; i < 50; ++i) {
    write();
    let_pass(milliseconds(2));
  }
  EXPECT_TRUE(eventually([&] { return inbox.size() == sample.header.sequence; })) << inbox.size();
}

TEST(Successor, OnItsWayIsNotWaitedForByTheEnd) {
  bus::Participant a(options(102, "imu_bridge"));
  bus::WriterOptions with;
  with.successor_after = 1;
  bus::Writer<ImuSample> writer(a, with);
  EXPECT_TRUE(writer.write(ImuSample{}));
}

/// How the thread is scheduled that hands over samples of a participant made with `made_with`.
int policy_of_handler(bus::ParticipantOptions made_with) {
  bus::Participant a(options(103, "gps_bridge"));
  bus::Participant b(made_with);
  std::promise<int> policy;
  bus::Writer<GpsSample> writer(a);
  bus::Reader<GpsSample> reader(
      b, [&](const GpsSample&, const bus::SampleInfo&) { policy.set_value(sched_getscheduler(0)); });
  EXPECT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));
  const auto others = a.peers();
  EXPECT_EQ(others.size(), 1U);
  for (const bus::Peer& other : others) EXPECT_EQ(other.low_priority, made_with.low_priority);
  EXPECT_TRUE(writer.write(GpsSample{}));
  auto said = policy.get_future();
  return said.wait_for(std::chrono::seconds(10)) == std::future_status::ready ? said.get() : -1;
}

TEST(Delivery, OneThatLooksOnGivesWay) {
  ASSERT_EQ(sched_getscheduler(0), SCHED_OTHER);
  bus::ParticipantOptions made_with = options(103, "monitor");
  EXPECT_EQ(policy_of_handler(made_with), SCHED_OTHER);
  made_with.low_priority = true;
  EXPECT_EQ(policy_of_handler(made_with), SCHED_BATCH);
}

TEST(Delivery, WithinOneParticipant) {
  bus::Participant participant(options(103, "both"));
  Inbox<GpsSample> inbox;
  bus::Writer<GpsSample> writer(participant);
  bus::Reader<GpsSample> reader(participant, inbox.handler());
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));
  ASSERT_TRUE(writer.write(GpsSample{}));
  EXPECT_TRUE(eventually([&] { return inbox.size() == 1; }));
}

TEST(Delivery, ManyKeysOfOneTopic) {
  bus::Participant a(options(104, "a"));
  bus::Participant b(options(104, "b"));
  Inbox<GpsSample> inbox;
  bus::Writer<GpsSample> writer(a);
  bus::Reader<GpsSample> reader(b, inbox.handler());
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));
  GpsSample sample;
  for (int i = 0; i < 30; ++i) {
    sample.header.sensor = Name("gps" + std::to_string(i));
    ASSERT_TRUE(writer.write(sample)) << i;
  }
  EXPECT_TRUE(eventually([&] { return inbox.size() == 30; })) << inbox.size();
  EXPECT_EQ(a.counters().write_failed, 0U);
}

TEST(Delivery, TooManyKeysAreCountedAndReported) {
  bus::Participant a(options(104, "a"));
  const Events events(a);
  bus::Writer<GpsSample> writer(a);
  GpsSample sample;
  int refused = 0;
  for (int i = 0; i < 40; ++i) {
    sample.header.sensor = Name("gps" + std::to_string(i));
    refused += writer.write(sample) ? 0 : 1;
  }
  EXPECT_GT(refused, 0);
  EXPECT_EQ(a.counters().write_failed, static_cast<std::uint64_t>(refused));
  ASSERT_EQ(events.of(bus::BusEventKind::write_failed).size(), 1U);
  EXPECT_EQ(events.of(bus::BusEventKind::write_failed)[0].topic, "fathom/v1/gps");
}

TEST(Delivery, LateReaderGetsTheLastStatusOfEveryService) {
  bus::Participant a(options(105, "a"));
  bus::Writer<ServiceStatus> writer(a);
  ServiceStatus status;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 20; ++i) {
      status.header.sensor = Name("service" + std::to_string(i));
      status.pid = static_cast<std::uint32_t>(100 * round + i);
      ASSERT_TRUE(writer.write(status));
    }
  }
  bus::Participant b(options(105, "b"));
  Inbox<ServiceStatus> inbox;
  bus::Reader<ServiceStatus> reader(b, inbox.handler());
  ASSERT_TRUE(eventually([&] { return inbox.size() >= 20; })) << inbox.size();
  let_pass(milliseconds(100));
  ASSERT_EQ(inbox.size(), 20U);
  for (const auto& [got, info] : inbox.all()) EXPECT_GE(got.pid, 200U);
}

TEST(Delivery, LateReaderGetsNoOldSamplesAndNoOldOrders) {
  bus::Participant a(options(106, "a"));
  bus::Writer<ImuSample> imu(a);
  bus::Writer<Command> command(a);
  ASSERT_TRUE(imu.write(ImuSample{}));
  ASSERT_TRUE(command.write(Command{}));
  bus::Participant b(options(106, "b"));
  Inbox<ImuSample> samples;
  Inbox<Command> orders;
  bus::Reader<ImuSample> imu_reader(b, samples.handler());
  bus::Reader<Command> command_reader(b, orders.handler());
  ASSERT_TRUE(eventually([&] { return imu.matched_readers() == 1 && command.matched_readers() == 1; }));
  let_pass(milliseconds(200));
  EXPECT_EQ(samples.size(), 0U);
  EXPECT_EQ(orders.size(), 0U);
}

TEST(Delivery, ASlowReaderHoldsNobodyUp) {
  bus::Participant a(options(107, "a"));
  bus::Participant slow(options(107, "slow"));
  bus::Participant quick(options(107, "quick"));
  std::promise<void> release;
  const std::shared_future<void> released = release.get_future().share();
  std::atomic<int> slow_count = 0;
  Inbox<NavState> inbox;
  bus::Writer<NavState> writer(a);
  bus::Reader<NavState> slow_reader(slow, [&](const NavState&, const bus::SampleInfo&) {
    ++slow_count;
    released.wait();
  });
  bus::ReaderOptions deep;
  deep.profile_suffix = "deep";
  bus::Reader<NavState> quick_reader(quick, inbox.handler(), deep);
  ASSERT_TRUE(eventually([&] {
    return writer.matched_readers() == 2 && slow_reader.matched_writers() == 1 &&
           quick_reader.matched_writers() == 1;
  }));
  int held_up = 0;
  NavState state;
  for (int i = 0; i < 2000; ++i) {
    state.header.sequence = static_cast<std::uint64_t>(i);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_TRUE(writer.write(state));
    if (std::chrono::steady_clock::now() - start >= milliseconds(90)) ++held_up;
    if (i % 100 == 0) let_pass(milliseconds(1));
  }
  // A blocked write lasts for the profile's 100 ms, and each of the 2000 would; a busy machine delays a few.
  EXPECT_LT(held_up, 100);
  EXPECT_TRUE(eventually([&] { return inbox.size() == 2000; })) << inbox.size();
  EXPECT_EQ(slow_count, 1);
  release.set_value();
  EXPECT_TRUE(eventually([&] { return slow_count > 1; }));
}

// A machine that is busy for half a second as the writer ends.
TEST(Delivery, TheLastWordsOfAWriterReachAReaderThatIsHeldUp) {
  bus::Participant listens(options(101, "listens"));
  std::atomic<int> heard = 0;
  bus::Reader<Verdict> reader(listens, [&](const Verdict&, const bus::SampleInfo&) {
    if (heard++ == 1) let_pass(milliseconds(700));
  });
  {
    bus::Participant speaks(options(101, "speaks"));
    bus::Writer<Verdict> writer(speaks);
    ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));
    EXPECT_TRUE(writer.write(Verdict{}));
    ASSERT_TRUE(eventually([&] { return heard == 1; }));
    for (int i = 0; i < 200; ++i) EXPECT_TRUE(writer.write(Verdict{}));
  }
  EXPECT_TRUE(eventually([&] { return heard == 201; })) << heard;
}

TEST(Delivery, NoHandlerRunsOnceTheReaderIsGone) {
  bus::Participant a(options(108, "a"));
  bus::Participant b(options(108, "b"));
  bus::Writer<ImuSample> writer(a);
  std::atomic<bool> writing = true;
  std::thread source([&] {
    ImuSample sample;
    while (writing) {
      ++sample.header.sequence;
      writer.write(sample);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  });
  for (int round = 0; round < 15; ++round) {
    std::atomic<bool> alive = true;
    std::atomic<int> late = 0;
    std::atomic<int> count = 0;
    {
      bus::Reader<ImuSample> reader(b, [&](const ImuSample&, const bus::SampleInfo&) {
        ++count;
        std::this_thread::sleep_for(std::chrono::microseconds(500));
        if (!alive) ++late;
      });
      EXPECT_TRUE(eventually([&] { return count > 5; }));
    }
    alive = false;
    let_pass(milliseconds(2));
    EXPECT_EQ(late, 0);
  }
  writing = false;
  source.join();
}

}  // namespace
}  // namespace fathom::test
