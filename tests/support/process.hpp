#pragma once

#include <chrono>
#include <csignal>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/paths.hpp"

namespace fathom::test {

/// True as soon as `condition` holds; false when it did not within `seconds`.
inline bool wait_until(const std::function<bool()>& condition, double seconds = 10.0) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

/// A program of the build, ended with the object. Its standard output and error go to files that can be read.
class Process {
 public:
  /// `program`: name in build/bin, or the whole path of one of the system.
  Process(const std::string& program, const std::vector<std::string>& arguments) {
    const std::string path = program.starts_with("/") ? program : binary_dir() + "/bin/" + program;
    out_ = temporary();
    err_ = temporary();
    std::vector<std::string> words{path};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      dup2(out_, STDOUT_FILENO);
      dup2(err_, STDERR_FILENO);
      execv(path.c_str(), argv.data());
      _exit(127);
    }
  }
  ~Process() {
    if (running()) {
      kill(SIGKILL);
      (void)wait();
    }
    close(out_);
    close(err_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  void kill(int signal) {
    if (running()) ::kill(pid_, signal);
  }
  [[nodiscard]] bool running() {
    if (pid_ <= 0 || ended_) return false;
    ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
    return !ended_;
  }
  /// Waits for its end. The exit code, or 128 + the signal that ended it.
  int wait() {
    if (!ended_ && pid_ > 0) ended_ = waitpid(pid_, &status_, 0) == pid_;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  }
  [[nodiscard]] std::string out() const { return contents(out_); }
  [[nodiscard]] std::string err() const { return contents(err_); }
  /// True as soon as standard error holds `text`: a service's log is written after what it tells of.
  [[nodiscard]] bool says(const std::string& text, double seconds = 10.0) const {
    return wait_until([&] { return err().find(text) != std::string::npos; }, seconds);
  }

 private:
  static int temporary() {
    char name[] = "/tmp/fathom-test-XXXXXX";
    const int file = mkostemp(name, O_CLOEXEC);
    unlink(name);
    return file;
  }
  static std::string contents(int file) {
    std::string text;
    char buffer[4096];
    off_t at = 0;
    for (ssize_t n = 0; (n = pread(file, buffer, sizeof buffer, at)) > 0; at += n) {
      text.append(buffer, static_cast<std::size_t>(n));
    }
    return text;
  }

  pid_t pid_ = -1;
  int out_ = -1;
  int err_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

}  // namespace fathom::test
