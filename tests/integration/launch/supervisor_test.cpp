// Services that are started, watched and started again, with real processes.
#include "launch/supervisor.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "base/clock.hpp"
#include "launch/check.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::launch {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

constexpr DurationNs kPause_ns = 20 * kNsPerMillisecond;

Program shell(const std::string& name, const std::string& script) {
  return {name, "/bin/sh", {"-c", script}, false};
}

/// Gives `signs` life signs as a service does, makes the file `then`, and says nothing more, without an end.
Program speaker(const std::string& name, int signs, const std::string& then) {
  return {name,
          "/usr/bin/env",
          {"python3", "-c",
           "import os, socket, time\n"
           "there = os.environ['NOTIFY_SOCKET'].replace('@', '\\0')\n"
           "for i in range(" +
               std::to_string(signs) +
               "):\n"
               "  socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM).sendto(b'WATCHDOG=1', there)\n"
               "  time.sleep(0.05)\n"
               "open('" +
               then +
               "', 'w').close()\n"
               "time.sleep(1000)"},
          false};
}

using Said = std::vector<std::string>;

/// Polls until `done`, which sees all that was said, and returns that.
Said polled_until(Supervisor& supervisor, const std::function<bool(const Said&)>& done) {
  const SystemClock clock;
  Said all;
  while (!done(all)) {
    for (std::string& line : supervisor.poll(clock.monotonic_ns())) all.push_back(std::move(line));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return all;
}
Said polled(Supervisor& supervisor, const std::function<bool()>& done) {
  return polled_until(supervisor, [&](const Said&) { return done(); });
}

std::size_t lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::size_t out = 0;
  for (std::string line; std::getline(in, line);) ++out;
  return out;
}

/// Polls until somebody says it.
Said polled_until_said(Supervisor& supervisor, const std::string& part) {
  return polled_until(supervisor, [&](const Said& all) {
    return std::any_of(all.begin(), all.end(),
                       [&](const std::string& line) { return line.find(part) != std::string::npos; });
  });
}

TEST(Supervisor, GivesUpWhereTheFirstStartIsRefused) {
  const test::TemporaryFolder folder;
  Supervisor supervisor(folder.path(), kPause_ns);
  supervisor.start(shell("fusion", "exit 2"));
  const auto said = polled(supervisor, [&] { return supervisor.gave_up(); });
  EXPECT_THAT(said, ElementsAre("fusion ended with code 2, it refused its configuration"));
}

TEST(Supervisor, OneThatRefusesWhenItIsStartedAgainEndsNobodyAndIsTriedUntilItRuns) {
  const test::TemporaryFolder folder;
  // One that lives longer than the pause counts as running: a refusal takes far less on any machine.
  Supervisor supervisor(folder.path(), 2 * kNsPerSecond);
  // It has run and was killed; then its configuration is broken, then it is mended.
  const std::string script = "echo >> " + folder / "starts" + "; test -e " + folder / "broken" +
                             " && exit 2; test -e " + folder / "mended" + " || { touch " + folder / "broken" +
                             "; kill -9 $$; }; exec sleep 1000";
  supervisor.start(shell("gps_bridge", script));
  supervisor.start(shell("fusion", "echo >> " + folder / "fusion_starts" + "; exec sleep 1000"));
  const auto refused = polled(supervisor, [&] { return lines_of(folder / "starts") >= 4; });
  EXPECT_FALSE(supervisor.gave_up());
  EXPECT_THAT(refused, ElementsAre("gps_bridge was killed by signal Killed, it will be started again",
                                   "gps_bridge was started again",
                                   "gps_bridge ended with code 2, it refused its configuration"));
  std::ofstream(folder / "mended").flush();
  fs::remove(folder / "broken");
  EXPECT_THAT(polled_until_said(supervisor, "runs again"), Contains("gps_bridge runs again"));
  EXPECT_EQ(lines_of(folder / "fusion_starts"), 1U);
}

TEST(Supervisor, StartsAServiceAgainWhoseFolderOfLogsIsGone) {
  const test::TemporaryFolder folder;
  const fs::path logs = folder.path() / "logs";
  fs::create_directory(logs);
  Supervisor supervisor(logs, kPause_ns);
  const auto starts = [&] { return lines_of(folder / "starts"); };
  supervisor.start(shell("depth_bridge", "echo >> " + folder / "starts" + "; exit 4"));
  (void)polled(supervisor, [&] { return starts() >= 1; });
  fs::remove_all(logs);
  (void)polled(supervisor, [&] { return starts() >= 3; });
  EXPECT_TRUE(fs::exists(logs / "depth_bridge.log"));
  // Where there can be no folder it runs without a log.
  fs::remove_all(logs);
  std::ofstream(logs).flush();
  const std::size_t before = starts();
  (void)polled(supervisor, [&] { return starts() >= before + 2; });
}

TEST(Supervisor, OneThatCannotBeStartedForNowIsSaidOnceAndTriedAgain) {
  const test::TemporaryFolder folder;
  Supervisor supervisor(folder.path(), kPause_ns);
  supervisor.start(shell("fusion", "exit 4"));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{0, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  const auto said = polled_until_said(supervisor, "cannot be started");
  const SystemClock clock;
  std::this_thread::sleep_for(std::chrono::nanoseconds(2 * kPause_ns));
  EXPECT_TRUE(supervisor.poll(clock.monotonic_ns()).empty());
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_THAT(said.back(), HasSubstr("fusion cannot be started for now: "));
  EXPECT_THAT(polled_until_said(supervisor, "ended with code 4"),
              Contains("fusion ended with code 4, it will be started again"));
}

TEST(Supervisor, KillsAndStartsAgainWhatHangs) {
  const test::TemporaryFolder folder;
  Supervisor supervisor(folder.path(), kPause_ns, 500 * kNsPerMillisecond);
  supervisor.start(speaker("fusion", 3, folder / "spoken"));
  supervisor.start(shell("silent", "exec sleep 1000"));  // never gave one: nothing is known of it
  const auto said = polled_until_said(supervisor, "fusion was started again");
  EXPECT_THAT(said, Contains(HasSubstr("fusion hangs: it gave no life sign for")));
  EXPECT_THAT(said, Contains("fusion was killed by signal Killed, it will be started again"));
  EXPECT_THAT(said, Not(Contains(HasSubstr("silent"))));
}

TEST(Supervisor, ItsOwnStandstillIsNobodysSilence) {
  const test::TemporaryFolder folder;
  Supervisor supervisor(folder.path(), kPause_ns, 10 * kNsPerSecond);
  const std::string spoken = folder / "spoken";
  supervisor.start(speaker("fusion", 1, spoken));
  while (!fs::exists(spoken)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  TimeNs now_ns = SystemClock().monotonic_ns();
  EXPECT_TRUE(supervisor.poll(now_ns).empty());
  now_ns += 3600 * kNsPerSecond;  // an hour in which nobody looked: a second of it counts
  EXPECT_TRUE(supervisor.poll(now_ns).empty());
  for (int i = 0; i < 9; ++i) EXPECT_TRUE(supervisor.poll(now_ns += kNsPerSecond).empty()) << i;
  EXPECT_THAT(supervisor.poll(now_ns += kNsPerSecond), Contains(HasSubstr("fusion hangs")));
}

TEST(Complaints, NobodyIsLeftBehindWhereAnotherCannotBeAsked) {
  const test::TemporaryFolder folder;
  const std::vector<Program> programs{shell("fusion", "exit 0"),
                                      {"monitor", folder.path() / "is_not_there", {}, false}};
  EXPECT_THROW((void)complaints_of(programs), std::system_error);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is there, ended or not";
}

}  // namespace
}  // namespace fathom::launch
