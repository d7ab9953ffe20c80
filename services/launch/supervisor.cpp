#include "launch/supervisor.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom::launch {
namespace {

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status)) return std::string("was killed by signal ") + strsignal(WTERMSIG(status));
  return "ended with code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

Supervisor::Supervisor(std::filesystem::path log_directory, DurationNs restart_after_ns)
    : log_directory_(std::move(log_directory)), restart_after_ns_(restart_after_ns) {}

Supervisor::~Supervisor() {
  stop(2 * kNsPerSecond);
}

std::filesystem::path Supervisor::log_of(const std::string& name) const {
  return log_directory_ / (name + ".log");
}

void Supervisor::start(const Program& program) {
  children_.push_back({program, -1, 0, 0, false});
  spawn(children_.back());
}

void Supervisor::spawn(Child& child) {
  std::vector<std::string> words{child.program.executable.string()};
  words.insert(words.end(), child.program.arguments.begin(), child.program.arguments.end());
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const int log = open(log_of(child.program.name).c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (log < 0) throw std::system_error(errno, std::generic_category(), log_of(child.program.name).string());
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    // A process group of its own: Ctrl-C reaches the parent alone, which then stops its services in order.
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(4);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    // Sockets of our own participant must not stay open in a service that outlives it.
    close_range(STDERR_FILENO + 1, ~0U, 0);
    execv(argv[0], argv.data());
    dprintf(STDERR_FILENO, "%s: cannot be started: %s\n", argv[0], strerror(errno));
    _exit(4);
  }
  const int error = errno;
  close(log);
  if (pid < 0) throw std::system_error(error, std::generic_category(), "cannot start " + child.program.name);
  child.pid = pid;
}

std::vector<std::string> Supervisor::poll(TimeNs now_ns) {
  std::vector<std::string> said;
  for (auto& child : children_) {
    int status = 0;
    if (child.pid > 0 && waitpid(child.pid, &status, WNOHANG) == child.pid) {
      child.pid = -1;
      child.ended_ns = now_ns;
      child.hopeless = WIFEXITED(status) && WEXITSTATUS(status) == 2;
      gave_up_ = gave_up_ || (child.hopeless && !child.program.optional);
      said.push_back(child.program.name + " " + how_it_ended(status) +
                     (child.hopeless ? ", it refused its configuration" : ", it will be started again"));
    }
    if (child.pid < 0 && !child.hopeless && now_ns - child.ended_ns >= restart_after_ns_) {
      ++child.restarts;
      spawn(child);
      said.push_back(child.program.name + " was started again");
    }
  }
  return said;
}

std::vector<std::string> Supervisor::stop(DurationNs grace_ns) {
  std::vector<std::string> killed;
  for (const auto& child : children_) {
    if (child.pid > 0) kill(child.pid, SIGTERM);
  }
  const auto until = std::chrono::steady_clock::now() + std::chrono::nanoseconds(grace_ns);
  const auto any_left = [this] {
    bool left = false;
    for (auto& child : children_) {
      if (child.pid > 0 && waitpid(child.pid, nullptr, WNOHANG) == child.pid) child.pid = -1;
      left = left || child.pid > 0;
    }
    return left;
  };
  while (any_left() && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (auto& child : children_) {
    if (child.pid <= 0) continue;
    kill(child.pid, SIGKILL);
    waitpid(child.pid, nullptr, 0);
    child.pid = -1;
    killed.push_back(child.program.name);
  }
  children_.clear();
  return killed;
}

std::map<std::string, int> Supervisor::restarts() const {
  std::map<std::string, int> out;
  for (const auto& child : children_) out[child.program.name] = child.restarts;
  return out;
}

}  // namespace fathom::launch
