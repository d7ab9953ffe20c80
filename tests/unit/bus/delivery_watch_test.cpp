// A reader to which samples come and that hands none over is found, and nobody else.

#include "bus/detail/network/delivery_watch.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <future>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/detail/security/datagram_check.hpp"
#include "bus/detail/workarounds/work_queue.hpp"
#include "support/rtps_datagram.hpp"

namespace fathom::bus::detail {
namespace {

using test::rtps::Bytes;

constexpr EntityId kReader = 0x0000'0104;

WriterGuid writer(std::uint8_t number) {
  WriterGuid guid{};
  guid[0] = number;
  return guid;
}

class Deliveries : public testing::Test {
 protected:
  Deliveries() { join(false); }

  void join(bool one_at_a_time) {
    delivery_watch.leave(this);
    delivery_watch.join(this, one_at_a_time, [this] { ++deaf; });
    delivery_watch.is_entity(this, kReader);
    delivery_watch.matched(this, writer(1));
    delivery_watch.matched(this, writer(2));
  }
  /// One arrives every tenth of a second.
  void arrive(int count, const WriterGuid& from, EntityId to = kReader) {
    for (int i = 0; i < count; ++i) {
      now_ns += kNsPerSecond / 10;
      EXPECT_TRUE(delivery_watch.arrived({from, to, ++number, true}));
    }
  }

  TimeNs now_ns = 0;
  DeliveryWatch delivery_watch{[this] { return now_ns; }};
  int deaf = 0;
  std::uint64_t number = 0;
};

TEST_F(Deliveries, NoneHandedOverForThreeSeconds) {
  arrive(30, writer(1));
  EXPECT_EQ(deaf, 0);
  arrive(1, writer(1));
  EXPECT_EQ(deaf, 1);
  arrive(30, writer(1), 0);  // to any reader of it
  EXPECT_EQ(deaf, 1);
  arrive(1, writer(1), 0);
  EXPECT_EQ(deaf, 2);
}

TEST_F(Deliveries, OneHandedOverNowAndThenIsEnough) {
  for (int i = 0; i < 10; ++i) {
    arrive(20, writer(1));
    delivery_watch.heard(this, writer(1));
  }
  EXPECT_EQ(deaf, 0);
}

TEST_F(Deliveries, AnotherWritersSamplesDoNotHelpUnlessOneOwnsTheInstance) {
  for (int i = 0; i < 40; ++i) {
    arrive(1, writer(1));
    delivery_watch.heard(this, writer(2));
  }
  EXPECT_EQ(deaf, 1);
  join(true);
  for (int i = 0; i < 40; ++i) {
    arrive(1, writer(1));
    delivery_watch.heard(this, writer(2));
  }
  EXPECT_EQ(deaf, 1);
}

TEST_F(Deliveries, AFewThatCameLongAgoAreNothing) {
  arrive(4, writer(1));
  now_ns += 3600 * kNsPerSecond;
  EXPECT_EQ(deaf, 0);
}

TEST_F(Deliveries, ASilenceAfterALostSampleIsNotTheReadersFault) {
  arrive(1, writer(1));  // kept, for one before it was lost
  now_ns += 5 * kNsPerSecond;
  arrive(19, writer(1));  // until that is sent again
  EXPECT_EQ(deaf, 0);
  arrive(2, writer(1));
  EXPECT_EQ(deaf, 1);
}

TEST_F(Deliveries, SamplesThatComeSeldomCountAsWell) {
  for (int i = 0; i < DeliveryWatch::kSamples; ++i) {
    EXPECT_EQ(deaf, 0);
    now_ns += 10 * kNsPerSecond;
    arrive(1, writer(1));
  }
  EXPECT_EQ(deaf, 1);
}

TEST_F(Deliveries, WhatIsNotForThisReaderIsNothing) {
  arrive(100, writer(1), kReader + 256);
  arrive(100, writer(3));
  delivery_watch.unmatched(this, writer(1));
  arrive(100, writer(1));
  delivery_watch.leave(this);
  arrive(100, writer(2));
  EXPECT_EQ(deaf, 0);
}

TEST_F(Deliveries, WhatWasRefusedForWantOfRoomWasHeard) {
  for (int i = 0; i < 10; ++i) {
    arrive(20, writer(1));
    delivery_watch.refused(this);
  }
  EXPECT_EQ(deaf, 0);
}

TEST_F(Deliveries, ALeapThatNoWriterMakesIsNotTrue) {
  constexpr std::uint64_t kLongAfloat = 40'000'000;
  EXPECT_TRUE(delivery_watch.arrived({writer(1), 0, kLongAfloat, false}));  // how far it was when we met
  EXPECT_TRUE(delivery_watch.arrived({writer(1), kReader, kLongAfloat + DeliveryWatch::kLeap, false}));
  EXPECT_TRUE(delivery_watch.arrived({writer(1), kReader, 7, true}));
  EXPECT_FALSE(
      delivery_watch.arrived({writer(1), kReader, kLongAfloat + 2 * DeliveryWatch::kLeap + 1, false}));
  EXPECT_FALSE(delivery_watch.arrived({writer(1), 0, ~std::uint64_t{0}, true}));
  EXPECT_TRUE(
      delivery_watch.arrived({writer(3), 0, ~std::uint64_t{0}, false}));  // whom Fast DDS does not listen to
  delivery_watch.matched(this, writer(1));                                // anew
  EXPECT_TRUE(delivery_watch.arrived({writer(1), 0, 1, false}));
  EXPECT_FALSE(delivery_watch.arrived({writer(1), 0, kLongAfloat, false}));
}

TEST_F(Deliveries, DiscoveryIsNotLong) {
  WriterGuid discovery = writer(9);
  discovery[15] = 0xC2;
  EXPECT_TRUE(delivery_watch.arrived({discovery, 0, DeliveryWatch::kDiscovery, false}));
  EXPECT_FALSE(delivery_watch.arrived({discovery, 0, DeliveryWatch::kDiscovery + 1, false}));
}

TEST(Claims, AreToldWithWriterReaderAndNumber) {
  using test::rtps::Bytes;
  const auto ids = [](Bytes message, std::size_t at, std::uint8_t reader, std::uint8_t from) {
    std::fill(message.begin() + static_cast<std::ptrdiff_t>(at), message.begin() + 24, 0);
    message[at + 2] = reader;
    message[at + 3] = 4;
    message[at + 6] = from;
    message[at + 7] = 3;
    return message;
  };
  const auto number = [](Bytes message, std::size_t at, std::uint8_t high, std::uint8_t low) {
    std::fill_n(message.begin() + static_cast<std::ptrdiff_t>(at), 8, 0);
    message[at] = high;
    message[at + 4] = low;
    return message;
  };
  using test::rtps::submessage;
  const Bytes heartbeat = number(ids(submessage(test::rtps::kHeartbeat, 28), 4, 1, 2), 12, 0, 5);
  const Bytes datagram = test::rtps::datagram({
      number(ids(test::rtps::data({}, 16), 8, 1, 2), 16, 0, 7),
      number(heartbeat, 20, 0, 9),
      number(heartbeat, 20, 0, 4),
      submessage(test::rtps::kTimestamp, 8),
      number(number(ids(submessage(0x08, 32), 4, 0, 8), 12, 0, 1), 20, 1, 1),
      number(ids(test::rtps::data({}, 16, true, -1, true), 8, 6, 7), 16, 0, 3),
  });
  std::vector<std::vector<std::uint64_t>> told;
  const auto tell = [&](const Claim& claim) {
    told.push_back(
        {claim.writer[0], claim.writer[14], claim.reader, claim.number, claim.carries_sample ? 1U : 0U});
    return told.size() < 5;
  };
  EXPECT_FALSE(all_claims(datagram, tell));
  using testing::ElementsAre;
  EXPECT_THAT(told, ElementsAre(ElementsAre(0x11, 2, 0x104, 7, 1), ElementsAre(0x11, 2, 0x104, 9, 0),
                                ElementsAre(0x11, 2, 0x104, 5, 0),
                                ElementsAre(0x11, 8, 0x004, (std::uint64_t{1} << 32U) + 1, 0),
                                ElementsAre(0x11, 7, 0x604, 3, 1)));
}

/// Of participant `who`, as far as its header.
Bytes datagram_of(std::uint8_t who) {
  Bytes bytes = test::rtps::datagram({});
  std::fill_n(bytes.begin() + 8, 12, who);
  return bytes;
}
GuidPrefix prefix(std::uint8_t who) {
  GuidPrefix made{};
  made.fill(who);
  return made;
}

TEST(DeliveryWatch, KnowsWhoWasHeardOfThoseAskedAbout) {
  TimeNs now_ns = 1;
  DeliveryWatch delivery_watch([&] { return now_ns; });
  delivery_watch.arrived_from(datagram_of(1));
  EXPECT_FALSE(delivery_watch.is_heard(prefix(1), kNsPerSecond));  // nobody had asked
  delivery_watch.arrived_from(datagram_of(2));
  EXPECT_FALSE(delivery_watch.is_heard(prefix(1), kNsPerSecond));
  delivery_watch.arrived_from(datagram_of(1));
  now_ns += kNsPerSecond;
  EXPECT_TRUE(delivery_watch.is_heard(prefix(1), kNsPerSecond));
  now_ns += 1;
  EXPECT_FALSE(delivery_watch.is_heard(prefix(1), kNsPerSecond));
  delivery_watch.arrived_from(datagram_of(1));
  delivery_watch.gone(prefix(1));
  EXPECT_FALSE(delivery_watch.is_heard(prefix(1), kNsPerSecond));
  delivery_watch.arrived_from(Bytes(19));  // too short to be of anybody
}

/// Keeps the thread of work_queue busy until told otherwise.
class Busy {
 public:
  explicit Busy(WorkQueue& work_queue) {
    work_queue.run(this, [this] {
      begun_.set_value();
      go_on_.get_future().wait();
    });
    begun_.get_future().wait();
  }
  void end() { go_on_.set_value(); }

 private:
  std::promise<void> begun_;
  std::promise<void> go_on_;
};

TEST(Task, TakesItsTurnWhenItsTimeHasCome) {
  std::vector<int> ran;  // by the one thread of work_queue
  std::promise<void> done;
  WorkQueue work_queue;
  Busy busy(work_queue);
  int one = 0;
  const auto last = [&] {
    ran.push_back(3);
    done.set_value();
  };
  work_queue.run(&one, last, 3, std::chrono::milliseconds(10));
  work_queue.run(
      &one, [&] { ran.push_back(2); }, 2, std::chrono::milliseconds(5));
  work_queue.run(
      &one, [&] { ran.push_back(20); }, 2);  // one of this kind waits
  work_queue.run(&one, [&] { ran.push_back(1); });
  busy.end();
  done.get_future().wait();
  EXPECT_EQ(ran, (std::vector<int>{1, 2, 3}));
}

TEST(Task, ThatAsksForAnotherIsForgottenWithIt) {
  std::atomic<int> ran = 0;
  WorkQueue work_queue;
  int one = 0;
  std::promise<void> begun;
  std::promise<void> go_on;
  work_queue.run(&one, [&] {
    begun.set_value();
    go_on.get_future().wait();
    work_queue.run(
        &one, [] {}, 0, std::chrono::hours(1));
  });
  begun.get_future().wait();
  go_on.set_value();
  work_queue.forget(&one);
  std::promise<void> done;
  work_queue.run(&one, [&] { ++ran; });  // not, if one of this kind still waits
  int another = 0;
  work_queue.run(&another, [&] { done.set_value(); });
  done.get_future().wait();
  EXPECT_EQ(ran, 1);
}

TEST(Task, RunsOnceForOneThatWaitsAndNeverForTheForgotten) {
  std::atomic<int> ran = 0;
  WorkQueue work_queue;
  std::promise<void> begun;
  std::promise<void> go_on;
  int first = 0;
  int second = 0;
  work_queue.run(&first, [&] {
    begun.set_value();
    go_on.get_future().wait();
  });
  begun.get_future().wait();
  work_queue.run(&second, [&] { ++ran; });
  work_queue.run(&second, [&] { ran += 10; });
  work_queue.run(&first, [&] { ran += 100; });
  work_queue.forget(&second);
  go_on.set_value();
  work_queue.forget(&first);  // waits for the one that runs
  std::promise<void> done;
  work_queue.run(&second, [&] { ++ran; });
  int third = 0;
  work_queue.run(&third, [&] { done.set_value(); });
  done.get_future().wait();
  EXPECT_EQ(ran, 1);
}

}  // namespace
}  // namespace fathom::bus::detail
