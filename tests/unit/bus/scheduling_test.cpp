#include "bus/detail/scheduling.hpp"

#include <thread>

#include <gtest/gtest.h>
#include <sched.h>

namespace fathom::test {
namespace {

int policy() {
  return sched_getscheduler(0);
}

int priority() {
  sched_param parameters{};
  return sched_getparam(0, &parameters) == 0 ? parameters.sched_priority : -1;
}

bool schedule(int policy, int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return sched_setscheduler(0, policy, &parameters) == 0;
}

/// Runs `body` on a thread that is scheduled so; false where the kernel does not let it.
template <class Body>
bool on_thread(int policy, int priority, Body body) {
  bool may = false;
  std::thread([&] {
    may = schedule(policy, priority);
    if (may) body();
  }).join();
  return may;
}

TEST(Scheduling, ChoresGiveWayAndWhatCarriesSamplesDoesNot) {
  ASSERT_TRUE(on_thread(SCHED_OTHER, 0, [] {
    std::thread chore;
    bus::detail::Scheduling before;
    {
      const bus::detail::ScopedChores chores;
      before = chores.before();
      chore = std::thread([&before] {
        EXPECT_EQ(policy(), SCHED_BATCH);
        bus::detail::carry_samples(before);
        EXPECT_EQ(policy(), SCHED_OTHER);
      });
      chore.join();
    }
    EXPECT_EQ(before.policy, SCHED_OTHER);
    EXPECT_EQ(policy(), SCHED_OTHER);
  }));
}

TEST(Scheduling, WhatGivesWayAlreadyStaysAsItIs) {
  ASSERT_TRUE(on_thread(SCHED_BATCH, 0, [] {
    {
      const bus::detail::ScopedChores chores;
      EXPECT_EQ(chores.before().policy, SCHED_BATCH);
      EXPECT_EQ(policy(), SCHED_BATCH);
    }
    EXPECT_EQ(policy(), SCHED_BATCH);
  }));
}

TEST(Scheduling, InRealTimeChoresAreOnePriorityBelow) {
  const bool may = on_thread(SCHED_FIFO, 20, [] {
    {
      const bus::detail::ScopedChores chores;
      EXPECT_EQ(chores.before().priority, 20);
      std::thread([before = chores.before()] {
        EXPECT_EQ(policy(), SCHED_FIFO);
        EXPECT_EQ(priority(), 19);
        bus::detail::carry_samples(before);
        EXPECT_EQ(priority(), 20);
      }).join();
    }
    EXPECT_EQ(priority(), 20);
  });
  if (!may) GTEST_SKIP() << "needs CAP_SYS_NICE or RLIMIT_RTPRIO";
}

TEST(Scheduling, TheLowestRealTimePriorityHasNoneBelow) {
  const bool may = on_thread(SCHED_FIFO, 1, [] {
    const bus::detail::ScopedChores chores;
    EXPECT_EQ(priority(), 1);
  });
  if (!may) GTEST_SKIP() << "needs CAP_SYS_NICE or RLIMIT_RTPRIO";
}

}  // namespace
}  // namespace fathom::test
