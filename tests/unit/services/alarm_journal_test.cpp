#include "monitor/alarm_journal.hpp"

#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom::monitor {
namespace {

using health::AlarmEvent;

constexpr TimeNs kNow = 1'700'000'000 * kNsPerSecond;

class AlarmJournalTest : public ::testing::Test {
 protected:
  AlarmJournalTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fathom-journal-XXXXXX").string();
    folder = mkdtemp(pattern.data());
    path = (folder / "deep" / "alarms.jsonl").string();
  }
  ~AlarmJournalTest() override { std::filesystem::remove_all(folder); }

  static Alarm alarm(const std::string& text) {
    Alarm out;
    out.header.vehicle = "auv";
    out.alarm = "gps_outage";
    out.severity = Severity::warning;
    out.active = true;
    out.since_ns = kNow;
    out.text = text;
    out.value = 12.5;
    return out;
  }
  [[nodiscard]] std::string contents() const {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void put(const std::string& bytes) const {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  }
  /// Every line as JSON; fails the test when one is none or the last has no end.
  [[nodiscard]] std::vector<nlohmann::json> lines() const {
    std::vector<nlohmann::json> out;
    const std::string all = contents();
    EXPECT_TRUE(all.empty() || all.back() == '\n') << all;
    std::istringstream stream(all);
    for (std::string line; std::getline(stream, line);) {
      auto json = nlohmann::json::parse(line, nullptr, false);
      EXPECT_FALSE(json.is_discarded()) << line;
      out.push_back(std::move(json));
    }
    return out;
  }

  std::filesystem::path folder;
  std::string path;
};

TEST_F(AlarmJournalTest, KeepsOneObjectALineAndGoesOnWhereItWas) {
  {
    AlarmJournal journal(path);
    ASSERT_TRUE(journal.open(kNow)) << journal.error();
    EXPECT_TRUE(journal.append({AlarmEvent::raised, alarm("No fix for 5.0 s.")}, kNow));
  }
  AlarmJournal journal(path);
  ASSERT_TRUE(journal.open(kNow));
  EXPECT_TRUE(journal.append({AlarmEvent::cleared, alarm("A \"quoted\"\nline.")}, kNow + kNsPerSecond));
  const auto all = lines();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0]["event"], "raised");
  EXPECT_EQ(all[0]["alarm"], "gps_outage");
  EXPECT_EQ(all[0]["severity"], "warning");
  EXPECT_EQ(all[0]["time_utc"], "2023-11-14T22:13:20.000Z");
  EXPECT_EQ(all[0]["value"], 12.5);
  EXPECT_TRUE(all[0]["limit"].is_null()) << "unknown is null";
  EXPECT_EQ(all[1]["text"], "A \"quoted\"\nline.");
  EXPECT_EQ(journal.counters().lines, 1U);
}

TEST_F(AlarmJournalTest, APowerCutAnywhereInTheLastLineCostsThatLineOnly) {
  {
    AlarmJournal journal(path);
    ASSERT_TRUE(journal.open(kNow));
    journal.append({AlarmEvent::raised, alarm("The first.")}, kNow);
    journal.append({AlarmEvent::cleared, alarm("The second.")}, kNow);
  }
  const std::string whole = contents();
  const std::size_t first = whole.find('\n') + 1;
  // Every length from shortly before the last line on, some of before.
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    if (length > 1 && length + 2 < first && length % 16 != 0) continue;
    put(whole.substr(0, length));
    AlarmJournal journal(path);
    ASSERT_TRUE(journal.open(kNow)) << journal.error();
    ASSERT_TRUE(journal.append({AlarmEvent::raised, alarm("After the cut.")}, kNow));
    const auto all = lines();
    const bool torn = length != 0 && length != first && length != whole.size();
    const std::size_t complete = length < first ? 0 : length < whole.size() ? 1 : 2;
    ASSERT_EQ(all.size(), complete + (torn ? 1 : 0) + 1) << length;
    if (complete > 0) {
      EXPECT_EQ(all[0]["text"], "The first.");
    }
    if (torn) {
      EXPECT_EQ(all[complete]["event"], "repaired");
      EXPECT_EQ(all[complete]["torn"],
                whole.substr(complete == 0 ? 0 : first, length - (complete == 0 ? 0 : first)));
      EXPECT_GT(journal.counters().repaired_bytes, 0U);
    }
    EXPECT_EQ(all.back()["text"], "After the cut.");
  }
}

TEST_F(AlarmJournalTest, KnowsWhatWasActiveAndWhatNobodyAcknowledged) {
  {
    AlarmJournal journal(path);
    ASSERT_TRUE(journal.open(kNow));
    EXPECT_TRUE(journal.latched().empty());
    Alarm seen = alarm("Seen.");
    Alarm over = alarm("Over.");
    over.alarm = "sensor_missing:dvl";
    journal.append({AlarmEvent::raised, seen}, kNow);
    journal.append({AlarmEvent::raised, over}, kNow);
    seen.acknowledged = true;
    journal.append({AlarmEvent::acknowledged, seen}, kNow);
    over.active = false;
    over.severity = Severity::critical;
    over.cleared_ns = kNow + 1500 * kNsPerMillisecond;
    over.limit = kUnknown;
    journal.append({AlarmEvent::cleared, over}, kNow);
    journal.note("stopped", "in good order", kNow);
  }
  AlarmJournal journal(path);
  ASSERT_TRUE(journal.open(kNow));
  ASSERT_EQ(journal.latched().size(), 2U);
  EXPECT_TRUE(journal.latched().front().active);
  EXPECT_TRUE(journal.latched().front().acknowledged);
  const Alarm& left = journal.latched().back();
  EXPECT_EQ(left.alarm, Name("sensor_missing:dvl"));
  EXPECT_EQ(left.header.vehicle, Name("auv"));
  EXPECT_EQ(left.severity, Severity::critical);
  EXPECT_EQ(left.since_ns, kNow);
  EXPECT_EQ(left.cleared_ns, kNow + 1500 * kNsPerMillisecond);
  EXPECT_EQ(left.text, "Over.");
  EXPECT_EQ(left.value, 12.5);
  EXPECT_TRUE(std::isnan(left.limit));
}

TEST_F(AlarmJournalTest, LinesOfOthersAreNoAlarms) {
  put("{\"alarm\":3}\nnull\n[]\n{}\n{\"alarm\":\"a\",\"since_utc\":\"soon\",\"active\":\"yes\"}\n\xff\n");
  AlarmJournal journal(path);
  ASSERT_TRUE(journal.open(kNow)) << journal.error();
  ASSERT_EQ(journal.latched().size(), 1U);
  EXPECT_EQ(journal.latched().front().since_ns, 0);
  EXPECT_FALSE(journal.latched().front().active);
}

TEST_F(AlarmJournalTest, TailsOfGarbageAndOfZerosAreClosedToo) {
  for (const std::string& tail :
       {std::string(10'000, '\0'), std::string(9'000, '\xff'), std::string("\"{")}) {
    put("{\"event\":\"raised\"}\n" + tail);
    AlarmJournal journal(path);
    ASSERT_TRUE(journal.open(kNow));
    const auto all = lines();
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[1]["torn_bytes"], tail.size());
  }
}

TEST_F(AlarmJournalTest, SurvivesBeingKilledAtAnyMoment) {
  for (int lines_before = 0; lines_before < 15; ++lines_before) {
    std::array<int, 2> told{};
    ASSERT_EQ(pipe(told.data()), 0);
    const pid_t child = fork();
    if (child == 0) {
      AlarmJournal journal(path);
      if (!journal.open(kNow)) _exit(1);
      for (int i = 0; i < 100'000; ++i) {
        journal.append({AlarmEvent::raised, alarm("Number " + std::to_string(i))}, kNow);
        if (write(told[1], "", 1) != 1) _exit(1);
      }
      _exit(0);
    }
    close(told[1]);
    // Each line is told of: the kill meets the child wherever it is in one of the next.
    char byte = 0;
    for (int i = 0; i < lines_before; ++i) ASSERT_EQ(read(told[0], &byte, 1), 1);
    kill(child, SIGKILL);
    close(told[0]);
    int status = 0;
    waitpid(child, &status, 0);
    AlarmJournal journal(path);
    ASSERT_TRUE(journal.open(kNow)) << journal.error();
    ASSERT_TRUE(journal.note("started", "again", kNow));
    EXPECT_EQ(lines().back()["event"], "started");
  }
}

TEST_F(AlarmJournalTest, ADiskWithoutRoomCostsWholeLinesAndIsSaid) {
  AlarmJournal journal(path);
  ASSERT_TRUE(journal.open(kNow));
  ASSERT_TRUE(journal.append({AlarmEvent::raised, alarm("Fits.")}, kNow));
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{contents().size() + 40, before.rlim_max};  // room for a part of the next line
  setrlimit(RLIMIT_FSIZE, &tight);
  const bool written = journal.append({AlarmEvent::cleared, alarm("Does not.")}, kNow);
  const std::string error = journal.error();
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_FALSE(written);
  EXPECT_NE(error.find(path), std::string::npos) << error;
  EXPECT_EQ(journal.counters().failures, 1U);
  EXPECT_TRUE(journal.append({AlarmEvent::raised, alarm("Room again.")}, kNow));
  EXPECT_TRUE(journal.error().empty());
  const auto all = lines();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[1]["text"], "Room again.");
}

TEST_F(AlarmJournalTest, RefusesWhatIsNoFileOfItsOwn) {
  AlarmJournal first(path);
  ASSERT_TRUE(first.open(kNow));
  AlarmJournal second(path);
  EXPECT_FALSE(second.open(kNow));
  EXPECT_NE(second.error().find("another process"), std::string::npos) << second.error();
  EXPECT_FALSE(second.append({AlarmEvent::raised, alarm("Lost.")}, kNow));
  EXPECT_EQ(second.counters().failures, 1U);
  AlarmJournal device("/dev/null");
  EXPECT_FALSE(device.open(kNow));
  EXPECT_NE(device.error().find("regular file"), std::string::npos) << device.error();
  AlarmJournal directory(folder.string());
  EXPECT_FALSE(directory.open(kNow));
  AlarmJournal below_a_file(path + "/alarms");
  EXPECT_FALSE(below_a_file.open(kNow));
  EXPECT_NE(below_a_file.error().find("cannot be opened"), std::string::npos) << below_a_file.error();
}

}  // namespace
}  // namespace fathom::monitor
