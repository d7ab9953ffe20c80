#include "bus/detail/in_order.hpp"

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "unit/bus/bodies.hpp"

namespace fathom::bus::detail {
namespace {

const WriterGuid kFirst = guid(1, 1);
const WriterGuid kSecond = guid(1, 2);
const WriterGuid kThird = guid(1, 3);

/// What a reader makes of arrivals; a sample is an int.
class Reading {
 public:
  explicit Reading(std::initializer_list<WriterGuid> writers) {
    for (const WriterGuid& writer : writers) order.matched(writer);
  }
  /// Some arrive at once.
  struct One {
    Arrival arrival;
    int sample;
  };
  void arrive(const std::vector<One>& together, TimeNs now_ns = 0) {
    for (const One& one : together) {
      if (order.may_pass(one.arrival)) {
        heard.push_back(one.sample);
      } else {
        order.keep(one.arrival, one.sample, now_ns);
      }
    }
    settle(now_ns);
  }
  void settle(TimeNs now_ns = 0) {
    order.settle();
    while (const auto sample = order.next(now_ns)) heard.push_back(*sample);
  }
  InOrder<int> order;
  std::vector<int> heard;
};

Arrival of(const WriterGuid& writer, std::uint64_t number) {
  return {{writer, number}};
}
Arrival of(const WriterGuid& writer, std::uint64_t number, const WriterGuid& before, std::uint64_t last) {
  return {{writer, number}, Arrival::Place{before, last}};
}

TEST(InOrder, WhatASuccessorWroteWaitsForTheLastOfItsPredecessor) {
  Reading one{kFirst, kSecond};
  one.arrive({{of(kFirst, 1), 1}});
  one.arrive({{of(kSecond, 1, kFirst, 3), 4}});
  one.arrive({{of(kSecond, 2), 5}});  // no longer says so, and waits all the same
  EXPECT_EQ(one.heard, (std::vector<int>{1}));
  one.arrive({{of(kFirst, 2), 2}});
  EXPECT_EQ(one.heard, (std::vector<int>{1, 2}));
  one.arrive({{of(kFirst, 3), 3}});
  one.arrive({{of(kSecond, 3), 6}});
  EXPECT_EQ(one.heard, (std::vector<int>{1, 2, 3, 4, 5, 6}));
}

TEST(InOrder, NobodyWaitsWhereNothingIsMissing) {
  Reading one{kFirst, kSecond};
  one.arrive({{of(kFirst, 7), 1}});
  one.arrive({{of(kSecond, 1, kFirst, 7), 2}});
  EXPECT_EQ(one.heard, (std::vector<int>{1, 2}));
  EXPECT_FALSE(one.order.keeps());
}

TEST(InOrder, InstancesAreNotTakenInTheOrderOfArrival) {
  // The last one of the first writer is of another instance and is taken before two that arrived earlier.
  Reading one{kFirst, kSecond};
  one.arrive({{of(kFirst, 3), 3}, {of(kSecond, 1, kFirst, 3), 4}, {of(kFirst, 2), 2}});
  EXPECT_EQ(one.heard, (std::vector<int>{3, 2, 4}));
}

TEST(InOrder, ThreeInARow) {
  Reading one{kFirst, kSecond, kThird};
  one.arrive({{of(kThird, 1, kSecond, 2), 5}});
  one.arrive({{of(kSecond, 1, kFirst, 2), 3}, {of(kSecond, 2, kFirst, 2), 4}});
  one.arrive({{of(kFirst, 1), 1}});
  EXPECT_EQ(one.heard, (std::vector<int>{1}));
  one.arrive({{of(kFirst, 2), 2}});
  EXPECT_EQ(one.heard, (std::vector<int>{1, 2, 3, 4, 5}));
}

TEST(InOrder, APredecessorThatLeftIsNotWaitedFor) {
  Reading one{kFirst, kSecond};
  one.arrive({{of(kSecond, 1, kFirst, 3), 1}});
  EXPECT_TRUE(one.heard.empty());
  one.order.unmatched(kFirst);
  one.settle();
  EXPECT_EQ(one.heard, (std::vector<int>{1}));
  one.arrive({{of(kSecond, 2, kFirst, 3), 2}});
  EXPECT_EQ(one.heard, (std::vector<int>{1, 2}));
}

TEST(InOrder, NobodyIsHeldUpForEver) {
  Reading one{kFirst, kSecond};
  one.arrive({{of(kSecond, 1, kFirst, 3), 1}}, 0);
  one.settle(InOrder<int>::kMost_ns - 1);
  EXPECT_TRUE(one.heard.empty());
  one.settle(InOrder<int>::kMost_ns);
  EXPECT_EQ(one.heard, (std::vector<int>{1}));
}

TEST(InOrder, ThereIsRoomForSoMany) {
  Reading one{kFirst, kSecond};
  constexpr int kRoom = static_cast<int>(InOrder<int>::kRoom);
  for (int i = 1; i <= kRoom + 2; ++i) {
    one.arrive({{of(kSecond, static_cast<std::uint64_t>(i), kFirst, 3), i}});
  }
  EXPECT_EQ(one.heard, (std::vector<int>{1, 2}));
}

TEST(InOrder, NobodySpeaksForAnotherParticipant) {
  const WriterGuid stranger = guid(2, 1);
  Reading one{kFirst, stranger};
  one.arrive({{of(stranger, 1, kFirst, 1000), 1}});
  EXPECT_EQ(one.heard, (std::vector<int>{1}));
}

}  // namespace
}  // namespace fathom::bus::detail
