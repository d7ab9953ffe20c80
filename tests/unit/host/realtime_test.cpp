#include "host/realtime.hpp"

#include <cerrno>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>

#include "support/sanitized.hpp"

namespace fathom::host {
namespace {

using config::RealtimeConfig;
using config::SchedulingPolicy;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A kernel that answers as told and remembers what it was asked.
struct FakeKernel {
  int fifo_error = 0;
  std::uint64_t priority_limit = 0;
  bool may_lock = true;
  int lock_error = 0;
  int asked_priority = 0;
  bool asked_lock = false;

  RealtimeCalls calls() {
    return {[this](int priority) {
              asked_priority = priority;
              return fifo_error;
            },
            [this] { return priority_limit; }, [this] { return may_lock; },
            [] { return std::uint64_t{8} << 20U; },
            [this] {
              asked_lock = true;
              return lock_error;
            }};
  }
};

RealtimeConfig everything() {
  return {SchedulingPolicy::fifo, 30, true};
}

TEST(Realtime, NothingIsAskedForUnlessConfigured) {
  FakeKernel kernel;
  EXPECT_THAT(apply_realtime({}, kernel.calls()), IsEmpty());
  EXPECT_EQ(kernel.asked_priority, 0);
  EXPECT_FALSE(kernel.asked_lock);
}

TEST(Realtime, WhatIsGrantedIsNoWarning) {
  FakeKernel kernel;
  EXPECT_THAT(apply_realtime(everything(), kernel.calls()), IsEmpty());
  EXPECT_EQ(kernel.asked_priority, 30);
  EXPECT_TRUE(kernel.asked_lock);
}

TEST(Realtime, ATooLowLimitIsNamedWithItsRemedy) {
  FakeKernel kernel;
  kernel.fifo_error = EPERM;
  kernel.priority_limit = 10;
  EXPECT_THAT(apply_realtime(everything(), kernel.calls()),
              ElementsAre("no SCHED_FIFO 30: RLIMIT_RTPRIO is 10, expected 30 (LimitRTPRIO=) "
                          "or CAP_SYS_NICE"));
  EXPECT_TRUE(kernel.asked_lock) << "the one does not depend on the other";
}

TEST(Realtime, AProhibitionInSpiteOfTheLimitIsNamedAsSuch) {
  FakeKernel kernel;
  kernel.fifo_error = EPERM;
  kernel.priority_limit = 30;
  EXPECT_THAT(apply_realtime(everything(), kernel.calls()),
              ElementsAre("no SCHED_FIFO 30: forbidden, expected RestrictRealtime=no and sched_setscheduler "
                          "allowed"));
}

TEST(Realtime, AnotherRefusalIsGivenInTheKernelsWords) {
  FakeKernel kernel;
  kernel.fifo_error = EINVAL;
  kernel.lock_error = ENOMEM;
  EXPECT_THAT(apply_realtime(everything(), kernel.calls()),
              ElementsAre("no SCHED_FIFO 30: Invalid argument", "memory not locked: Cannot allocate memory"));
}

TEST(Realtime, MemoryIsNotLockedUpToABoundThatLaterMappingsWouldHit) {
  FakeKernel kernel;
  kernel.may_lock = false;
  EXPECT_THAT(
      apply_realtime(everything(), kernel.calls()),
      ElementsAre(
          "memory not locked: RLIMIT_MEMLOCK is 8192 kB, expected infinity (LimitMEMLOCK=) or CAP_IPC_LOCK"));
  EXPECT_FALSE(kernel.asked_lock);
}

TEST(Realtime, ThreadsStartedAfterwardsInheritTheScheduling) {
  std::vector<std::string> warnings;
  int policy = -1;
  sched_param parameters{};
  // In a thread of its own, so that this process is left as it was.
  std::thread([&] {
    warnings = apply_realtime({SchedulingPolicy::fifo, 7, false});
    std::thread([&] {
      policy = sched_getscheduler(0);
      sched_getparam(0, &parameters);
    }).join();
  }).join();
  if (!warnings.empty()) {
    EXPECT_EQ(policy, SCHED_OTHER);
    GTEST_SKIP() << "not permitted here: " << warnings.front();
  }
  EXPECT_EQ(policy, SCHED_FIFO);
  EXPECT_EQ(parameters.sched_priority, 7);
}

/// Locked memory of this process as the kernel counts it, in kB.
long locked_kb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    long value = -1;
    if (word == "VmLck:" && status >> value) return value;
  }
  return -1;
}

TEST(Realtime, LockedMemoryIsCountedByTheKernel) {
  if (test::kSanitized) GTEST_SKIP() << "sanitizers do not lock memory";
  ASSERT_EQ(locked_kb(), 0);
  const auto warnings = apply_realtime({SchedulingPolicy::other, 1, true});
  const long locked = locked_kb();
  munlockall();
  if (!warnings.empty()) {
    EXPECT_EQ(locked, 0);
    GTEST_SKIP() << "not permitted here: " << warnings.front();
  }
  EXPECT_GT(locked, 1000);
}

}  // namespace
}  // namespace fathom::host
