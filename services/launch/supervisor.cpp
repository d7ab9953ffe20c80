#include "launch/supervisor.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <set>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom::launch {
namespace {

constexpr DurationNs kLongestLook_ns = kNsPerSecond;
/// So many silences is a start given, as systemd has it (TimeoutStartSec beside WatchdogSec).
constexpr DurationNs kSilencesAtStart = 9;

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status)) return std::string("was killed by signal ") + strsignal(WTERMSIG(status));
  return "ended with code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

Supervisor::Supervisor(std::filesystem::path log_directory, DurationNs restart_after_ns,
                       DurationNs silence_ns)
    : log_directory_(std::move(log_directory)), restart_after_ns_(restart_after_ns), silence_ns_(silence_ns) {
  if (silence_ns_ > 0) life_signs_.emplace();
}

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

int Supervisor::open_log(const Child& child) const {
  const std::filesystem::path path = log_of(child.program.name);
  constexpr int kAppend = O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC;
  int log = open(path.c_str(), kAppend, 0644);
  if (log >= 0) return log;
  const int error = errno;
  if (child.restarts == 0) throw std::system_error(error, std::generic_category(), path.string());
  // Folders of logs are tidied away. A service is worth more than its log.
  std::error_code ignored;
  std::filesystem::create_directories(log_directory_, ignored);
  log = open(path.c_str(), kAppend, 0644);
  if (log < 0) log = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (log < 0) throw std::system_error(error, std::generic_category(), path.string());
  return log;
}

void Supervisor::spawn(Child& child) {
  std::vector<std::string> words{child.program.executable.string()};
  words.insert(words.end(), child.program.arguments.begin(), child.program.arguments.end());
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  // Life signs are for us, not for who started us.
  std::vector<char*> environment;
  std::string own = life_signs_ ? life_signs_->variable() : std::string();
  for (char** one = environ; *one != nullptr; ++one) {
    if (!life_signs_ || !std::string_view(*one).starts_with("NOTIFY_SOCKET=")) environment.push_back(*one);
  }
  if (life_signs_) environment.push_back(own.data());
  environment.push_back(nullptr);

  const int log = open_log(child);
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
    execve(argv[0], argv.data(), environment.data());
    dprintf(STDERR_FILENO, "%s: cannot be started: %s\n", argv[0], strerror(errno));
    _exit(4);
  }
  const int error = errno;
  close(log);
  if (pid < 0) throw std::system_error(error, std::generic_category(), "cannot start " + child.program.name);
  child.pid = pid;
  child.silent_ns = 0;
  child.spoke = false;
}

std::vector<std::string> Supervisor::poll(TimeNs now_ns) {
  std::vector<std::string> said;
  if (life_signs_) kill_what_hangs(now_ns, said);
  for (auto& child : children_) {
    reap(child, now_ns, said);
    if (child.pid < 0 && !child.hopeless && now_ns - child.ended_ns >= restart_after_ns_)
      start_again(child, now_ns, said);
  }
  return said;
}

void Supervisor::reap(Child& child, TimeNs now_ns, std::vector<std::string>& said) {
  int status = 0;
  if (child.pid <= 0) return;
  if (waitpid(child.pid, &status, WNOHANG) != child.pid) {
    // It has lived longer than one that refuses: what was wrong is over.
    if (!child.trouble.empty() && now_ns - child.started_ns >= restart_after_ns_) {
      said.push_back(child.program.name + " runs again");
      child.trouble.clear();
    }
    return;
  }
  child.pid = -1;
  child.ended_ns = now_ns;
  const bool refused = WIFEXITED(status) && WEXITSTATUS(status) == 2;
  child.hopeless = refused && child.restarts == 0;
  gave_up_ = gave_up_ || (child.hopeless && !child.program.optional);
  std::string text = child.program.name + " " + how_it_ended(status) +
                     (refused ? ", it refused its configuration" : ", it will be started again");
  if (child.hopeless || !refused) {
    said.push_back(std::move(text));
  } else if (std::exchange(child.trouble, text) != text) {
    said.push_back(std::move(text));
  }
}

void Supervisor::kill_what_hangs(TimeNs now_ns, std::vector<std::string>& said) {
  // Time in which nobody listened proves nothing: this process may have been the one that stood still.
  const DurationNs listened = std::min(now_ns - std::exchange(listened_ns_, now_ns), kLongestLook_ns);
  const std::set<pid_t> heard = life_signs_->heard();
  for (auto& child : children_) {
    if (child.pid <= 0) continue;
    if (heard.contains(child.pid)) {
      child.speaks = child.spoke = true;
      child.silent_ns = 0;
      continue;
    }
    child.silent_ns += listened;
    if (!child.speaks || child.silent_ns <= (child.spoke ? 1 : kSilencesAtStart) * silence_ns_) continue;
    kill(child.pid, SIGKILL);  // the only signal that reaches one that is stopped
    said.push_back(child.program.name + " hangs: it gave no life sign for " +
                   std::to_string(child.silent_ns / kNsPerSecond) + " s and is killed");
    child.silent_ns = 0;
  }
}

void Supervisor::start_again(Child& child, TimeNs now_ns, std::vector<std::string>& said) {
  ++child.restarts;
  child.started_ns = now_ns;
  try {
    spawn(child);
    if (child.trouble.empty()) said.push_back(child.program.name + " was started again");
  } catch (const std::system_error& error) {
    child.ended_ns = now_ns;
    const std::string text = child.program.name + " cannot be started for now: " + error.what();
    if (std::exchange(child.trouble, text) != text) said.push_back(text);
  }
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
