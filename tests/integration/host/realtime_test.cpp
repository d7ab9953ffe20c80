// Section "realtime" in a real service: all of its threads, those of Fast DDS too, and what it says when
// refused.

#include "host/realtime.hpp"

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "integration/host/patience.hpp"
#include "samples/status/health.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;

constexpr int kPriority = 11;

/// Policies of a process's threads, counted.
struct Threads {
  int as_asked = 0;
  int one_below = 0;  ///< chores of the network
  int others = 0;
};

Threads threads_of(pid_t process) {
  Threads out;
  std::error_code gone;
  for (const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task", gone)) {
    const auto thread = static_cast<pid_t>(std::stol(entry.path().filename().string()));
    sched_param parameters{};
    sched_getparam(thread, &parameters);
    const int priority = sched_getscheduler(thread) == SCHED_FIFO ? parameters.sched_priority : 0;
    ++(priority == kPriority ? out.as_asked : priority == kPriority - 1 ? out.one_below : out.others);
  }
  return out;
}

/// An example of guidance that asks for everything, and an ear for its life sign.
class RealtimeService : public ::testing::Test {
 protected:
  void listen(std::uint32_t domain) {
    domain_ = domain;
    participant_ = std::make_unique<bus::Participant>(presence(domain, "ear"));
    reader_ = std::make_unique<bus::Reader<ServiceStatus>>(
        *participant_, [this](const ServiceStatus& status, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex_);
          heard_ = status;
        });
  }
  std::unique_ptr<Process> start() const {
    return std::make_unique<Process>(
        "fathom-guidance-example",
        std::vector<std::string>{
            "--config", source_dir() + "/deploy/config/guidance_example.json", "--set",
            "bus.domain=" + std::to_string(domain_), "--set",
            "bus.profiles_dir=" + source_dir() + "/deploy/dds", "--set", "realtime.policy=fifo", "--set",
            "realtime.priority=" + std::to_string(kPriority), "--set", "realtime.lock_memory=true"});
  }
  [[nodiscard]] bool heard() const { return !text_of_host().empty(); }
  [[nodiscard]] std::string text() const {
    const std::lock_guard lock(mutex_);
    return heard_.text;
  }

 private:
  std::string text_of_host() const {
    const std::lock_guard lock(mutex_);
    return heard_.host;
  }

  std::uint32_t domain_ = 0;
  mutable std::mutex mutex_;
  ServiceStatus heard_;
  std::unique_ptr<bus::Participant> participant_;
  std::unique_ptr<bus::Reader<ServiceStatus>> reader_;
};

TEST_F(RealtimeService, SchedulesAllOfItsThreadsAsAsked) {
  std::vector<std::string> refused;
  std::thread([&] {
    refused = host::apply_realtime({config::SchedulingPolicy::fifo, kPriority, false});
  }).join();
  if (!refused.empty()) GTEST_SKIP() << "CAP_SYS_NICE or RLIMIT_RTPRIO is missing: " << refused.front();
  if (!host::kernel_calls().may_lock_all())
    GTEST_SKIP() << "CAP_IPC_LOCK or an unlimited RLIMIT_MEMLOCK is missing";
  listen(62);
  const auto service = start();
  ASSERT_TRUE(wait_until([&] { return heard(); }, kPatience_s)) << service->err();
  const Threads threads = threads_of(service->pid());
  EXPECT_GE(threads.as_asked, 1);
  EXPECT_GT(threads.one_below, 3);  // Fast DDS's
  EXPECT_EQ(threads.others, 1);     // the log's
  EXPECT_THAT(text(), ::testing::Not(::testing::AnyOf(HasSubstr("SCHED_FIFO"), HasSubstr("not locked"))));
  service->kill(SIGTERM);
  EXPECT_EQ(service->wait(), 0) << service->err();
}

TEST_F(RealtimeService, SaysWhatItIsRefusedAndGoesOn) {
  listen(63);
  std::unique_ptr<Process> service;
  bool may_still = false;
  // The thread's own bounding set and the process's limits are what the service inherits.
  std::thread([&] {
    rlimit priority{0, 0};
    rlimit memory{};
    getrlimit(RLIMIT_MEMLOCK, &memory);
    const rlimit memory_before = memory;
    memory.rlim_cur = 65536;
    setrlimit(RLIMIT_RTPRIO, &priority);
    setrlimit(RLIMIT_MEMLOCK, &memory);
    prctl(PR_CAPBSET_DROP, CAP_SYS_NICE);
    prctl(PR_CAPBSET_DROP, CAP_IPC_LOCK);
    may_still = geteuid() == 0 &&
                (prctl(PR_CAPBSET_READ, CAP_SYS_NICE) == 1 || prctl(PR_CAPBSET_READ, CAP_IPC_LOCK) == 1);
    if (!may_still) service = start();
    setrlimit(RLIMIT_MEMLOCK, &memory_before);
  }).join();
  if (may_still) GTEST_SKIP() << "capabilities cannot be given up here";
  ASSERT_TRUE(wait_until([&] { return heard(); }, kPatience_s)) << service->err();
  EXPECT_THAT(text(), HasSubstr("RLIMIT_RTPRIO is 0, expected 11 (LimitRTPRIO=)"));
  EXPECT_THAT(text(), HasSubstr("RLIMIT_MEMLOCK is 64 kB, expected infinity (LimitMEMLOCK=)"));
  EXPECT_TRUE(service->says("RLIMIT_RTPRIO is 0")) << service->err();
  EXPECT_TRUE(service->says("RLIMIT_MEMLOCK is 64 kB")) << service->err();
  const Threads threads = threads_of(service->pid());
  EXPECT_EQ(threads.as_asked + threads.one_below, 0);
  service->kill(SIGTERM);
  EXPECT_EQ(service->wait(), 0) << service->err();
}

}  // namespace
}  // namespace fathom::test
