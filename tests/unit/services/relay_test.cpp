#include "cli/solve/relay.hpp"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace fathom::cli {
namespace {

TEST(Relay, DoesTheWorkInOrderInAnotherThread) {
  std::vector<int> done;
  std::atomic<bool> elsewhere{false};
  const auto here = std::this_thread::get_id();
  Relay<int> relay([&](int item) {
    if (std::this_thread::get_id() != here) elsewhere = true;
    done.push_back(item);
  });
  constexpr int kItems = 100'000;
  for (int i = 0; i < kItems; ++i) relay.give(i);
  relay.finish();
  ASSERT_EQ(done.size(), static_cast<std::size_t>(kItems));
  for (int i = 0; i < kItems; ++i) ASSERT_EQ(done[static_cast<std::size_t>(i)], i);
  EXPECT_TRUE(elsewhere);
}

TEST(Relay, NothingGivenIsNothingDone) {
  int done = 0;
  Relay<int> relay([&](int) { ++done; });
  relay.finish();
  EXPECT_EQ(done, 0);
}

TEST(Relay, TheGiverWaitsForWorkThatIsFarBehind) {
  std::atomic<int> given{0};
  std::atomic<int> most{0};
  int done = 0;
  Relay<int> relay([&](int) {
    ++done;
    most = std::max(most.load(), given - done);
  });
  for (int i = 0; i < 50'000; ++i) {
    ++given;
    relay.give(i);
  }
  relay.finish();
  EXPECT_LE(most, static_cast<int>(Relay<int>::kMostBehind));
}

TEST(Relay, WhatWorkThrowsComesOut) {
  const auto work = [](int item) {
    if (item == 700) throw std::runtime_error("the disk is full");
  };
  Relay<int> relay(work);
  EXPECT_THROW(
      {
        for (int i = 0; i < 100'000; ++i) relay.give(i);
        relay.finish();
      },
      std::runtime_error);
  EXPECT_THROW(relay.finish(), std::runtime_error) << "and again: nothing waits for work that has ended";
  Relay<int> late(work);
  for (int i = 0; i < 701; ++i) late.give(i);  // the last of them, found when all is done
  EXPECT_THROW(late.finish(), std::runtime_error);
}

TEST(Relay, MayBeLeftBeforeItsWorkIsDone) {
  std::atomic<int> done{0};
  {
    Relay<int> relay([&](int) { ++done; });
    for (int i = 0; i < 300; ++i) relay.give(i);
  }
  EXPECT_LE(done, 300);
}

}  // namespace
}  // namespace fathom::cli
