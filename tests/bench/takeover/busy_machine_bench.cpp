// Two fusion services on a machine that has too much to do: how often the lead changes, and what guidance is
// handed. FATHOM_SOAK=1: for 30 s.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <fathom/client.hpp>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "guidance.hpp"

namespace fathom::test {
namespace {

/// Twice as many compilers as there are processors, as far as they matter: they never wait.
class BusyMachine {
 public:
  BusyMachine() {
    const unsigned count = 2 * std::max(1U, std::thread::hardware_concurrency());
    for (unsigned i = 0; i < count; ++i) {
      const pid_t pid = fork();
      if (pid == 0) {
        for (std::atomic<std::uint64_t> work = 0;;) work.fetch_add(1, std::memory_order_relaxed);
      }
      pids_.push_back(pid);
    }
  }
  ~BusyMachine() {
    for (const pid_t pid : pids_) {
      ::kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
    }
  }
  BusyMachine(const BusyMachine&) = delete;
  BusyMachine& operator=(const BusyMachine&) = delete;

 private:
  std::vector<pid_t> pids_;
};

TEST(Takeover, OnABusyMachine) {
  const bool soak = std::getenv("FATHOM_SOAK") != nullptr;
  const double span_s = soak ? 30.0 : 5.0;
  std::optional<Process> demo;
  std::optional<BusyMachine> busy;
  std::mutex mutex;
  std::vector<NavState> handed;
  Client client({.domain = kDomain, .vehicle = "auv"});
  Guidance guidance;
  ASSERT_TRUE(
      wait_until([&] { return under_way(guidance, demo, false, {"--standby"}, [] {}); }, 3.0 * kPatienceS));
  const TimeNs since_ns = SystemClock().utc_ns();
  ASSERT_TRUE(wait_until([&] { return guidance.both_in_step(since_ns); }, kPatienceS));
  client.on_nav_state([&](const NavState& state) {
    const std::lock_guard lock(mutex);
    handed.push_back(state);
  });
  busy.emplace();
  std::this_thread::sleep_for(std::chrono::duration<double>(span_s));
  busy.reset();
  const std::lock_guard lock(mutex);
  ASSERT_GT(handed.size(), 1U);
  std::size_t changes = 0;
  std::size_t twice = 0;
  double longest_s = 0.0;
  for (std::size_t i = 1; i < handed.size(); ++i) {
    const NavState& before = handed[i - 1];
    const NavState& after = handed[i];
    changes += before.header.sensor != after.header.sensor ? 1U : 0U;
    twice += before.header.stamp_ns == after.header.stamp_ns ? 1U : 0U;
    longest_s = std::max(longest_s, to_seconds(after.header.stamp_ns - before.header.stamp_ns));
  }
  const double due = 100.0 * to_seconds(handed.back().header.stamp_ns - handed.front().header.stamp_ns) + 1.0;
  std::printf(
      "on a busy machine, %.0f s: %zu changes of the leader, %zu states handed twice, %.1f %% missing, "
      "longest gap %.2f s\n",
      span_s, changes, twice, 100.0 * (1.0 - static_cast<double>(handed.size()) / due), longest_s);
  EXPECT_EQ(twice, 0U);
}

}  // namespace
}  // namespace fathom::test
