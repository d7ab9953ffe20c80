#include "bus/detail/workarounds/scheduling.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <thread>

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

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

/// How long the calling thread's turns are; 0 where the kernel does not say.
std::uint64_t turn_ns() {
  std::array<unsigned char, 48> attributes{};  // struct sched_attr
  if (syscall(SYS_sched_getattr, 0, attributes.data(), attributes.size(), 0) != 0) return 0;
  std::uint64_t runtime_ns = 0;
  std::memcpy(&runtime_ns, attributes.data() + 24, sizeof runtime_ns);
  return runtime_ns;
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

TEST(Scheduling, WhatCarriesSamplesAsksForShortTurns) {
  ASSERT_TRUE(on_thread(SCHED_OTHER, 0, [] {
    const bool told = turn_ns() != 0;
    // Whoever runs the tests may have been nice already.
    const int nicer = std::min(getpriority(PRIO_PROCESS, 0) + 3, 19);
    ASSERT_EQ(nice(3), nicer);
    bus::detail::ask_for_short_turns();
    EXPECT_EQ(turn_ns(), told ? bus::detail::kTurn_ns : 0);
    EXPECT_EQ(policy(), SCHED_OTHER);
    EXPECT_EQ(getpriority(PRIO_PROCESS, 0), nicer);
  }));
  ASSERT_TRUE(on_thread(SCHED_BATCH, 0, [] {
    const std::uint64_t before_ns = turn_ns();
    bus::detail::ask_for_short_turns();
    EXPECT_EQ(turn_ns(), before_ns);
    EXPECT_EQ(policy(), SCHED_BATCH);
  }));
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
