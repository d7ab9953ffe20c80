#include "support.hpp"

#include <atomic>
#include <csignal>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom::test {

Child::Child(const std::string& test, std::vector<std::string> variables) {
  std::string filter = "--gtest_filter=" + test;
  std::string disabled = "--gtest_also_run_disabled_tests";
  std::string self = "/proc/self/exe";
  std::vector<char*> arguments{self.data(), filter.data(), disabled.data(), nullptr};
  std::vector<char*> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) environment.push_back(*entry);
  for (std::string& variable : variables) environment.push_back(variable.data());
  environment.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addclosefrom_np(&actions, 3);  // our sockets are not the child's
  const int failed =
      posix_spawn(&pid_, self.c_str(), &actions, nullptr, arguments.data(), environment.data());
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) pid_ = -1;
  EXPECT_EQ(failed, 0) << "posix_spawn";
}

Child::~Child() {
  end(SIGKILL);
}

int Child::end(int signal) {
  if (pid_ < 0) return 0;
  int status = 0;
  kill(pid_, signal);
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return status;
}

void Child::kill_hard() {
  end(SIGKILL);
}
void Child::pause() {
  kill(pid_, SIGSTOP);
}
void Child::go_on() {
  kill(pid_, SIGCONT);
}
int Child::stop() {
  return end(SIGTERM);
}

namespace {
std::atomic<bool> stopped = false;
}

void until_stopped(milliseconds period, const std::function<void()>& step, milliseconds limit) {
  std::signal(SIGTERM, [](int) { stopped = true; });
  const auto end = std::chrono::steady_clock::now() + limit;
  for (auto next = std::chrono::steady_clock::now(); !stopped && next < end;) {
    step();
    next += period;
    std::this_thread::sleep_until(next);
  }
}

}  // namespace fathom::test
