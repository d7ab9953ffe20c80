#include "launch/check.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom::launch {
namespace {

/// One that is asked. What it says on standard error waits in the pipe.
struct Asked {
  pid_t pid = -1;
  int answer = -1;
};

Asked ask(const Program& program) {
  std::vector<std::string> words{program.executable.string()};
  words.insert(words.end(), program.arguments.begin(), program.arguments.end());
  words.emplace_back("--check");
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  Asked out;
  const int error = posix_spawn(&out.pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  out.answer = ends[0];
  if (error != 0) {
    close(out.answer);
    throw std::system_error(error, std::generic_category(), words.front());
  }
  return out;
}

/// Empty where it has nothing against it.
std::string answer_of(const Asked& asked, const Program& program) {
  std::string text;
  std::array<char, 4096> part{};
  while (true) {
    const ssize_t got = read(asked.answer, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(got));
  }
  close(asked.answer);
  int status = 0;
  while (waitpid(asked.pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  const std::string executable = program.executable.filename().string();
  if (text.starts_with(executable + ": ")) text.erase(0, executable.size() + 2);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? executable + " --check ended without a word" : text;
}

}  // namespace

std::vector<Complaint> complaints_of(const std::vector<Program>& programs) {
  std::vector<Asked> asked;
  try {
    for (const Program& program : programs) asked.push_back(ask(program));
  } catch (...) {  // those before it are not left behind
    for (std::size_t i = 0; i < asked.size(); ++i) (void)answer_of(asked[i], programs[i]);
    throw;
  }
  std::vector<Complaint> out;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    const std::string text = answer_of(asked[i], programs[i]);
    if (text.empty()) continue;
    const auto same =
        std::find_if(out.begin(), out.end(), [&](const Complaint& one) { return one.text == text; });
    if (same == out.end())
      out.push_back({{programs[i].name}, text});
    else
      same->names.push_back(programs[i].name);
  }
  return out;
}

}  // namespace fathom::launch
