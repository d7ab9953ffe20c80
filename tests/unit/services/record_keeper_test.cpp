#include "monitor/record_keeper.hpp"

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "monitor/outage_file.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::monitor {
namespace {

using health::AlarmEvent;

constexpr TimeNs kNow = 1'700'000'000 * kNsPerSecond;
constexpr double kPatience_s = 60.0;  ///< for the keeper's thread, which a busy machine holds up

/// Stands still until told otherwise. The keeper's thread reads it, too.
class TestClock : public Clock {
 public:
  [[nodiscard]] TimeNs utc_ns() const override { return kNow + monotonic_ns_; }
  [[nodiscard]] TimeNs monotonic_ns() const override {
    if (std::this_thread::get_id() != own_) read_elsewhere_ = true;
    return monotonic_ns_;
  }
  [[nodiscard]] double rate() const override { return rate_; }
  void advance(DurationNs by) { monotonic_ns_ += by; }
  void run_at(double rate) { rate_ = rate; }
  /// Whether the keeper's thread has read it: from then on it waits for the disk.
  [[nodiscard]] bool read_elsewhere() const { return read_elsewhere_; }

 private:
  const std::thread::id own_ = std::this_thread::get_id();
  mutable std::atomic<bool> read_elsewhere_{false};
  std::atomic<TimeNs> monotonic_ns_{kNsPerSecond};
  std::atomic<double> rate_{1.0};
};

class RecordKeeperTest : public ::testing::Test {
 protected:
  RecordKeeperTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fathom-records-XXXXXX").string();
    folder = mkdtemp(pattern.data());
    path = (folder / "alarms.jsonl").string();
  }
  ~RecordKeeperTest() override { std::filesystem::remove_all(folder); }

  static health::AlarmTransition raised(int number) {
    Alarm alarm;
    alarm.header.vehicle = "auv";
    alarm.alarm = Name("alarm" + std::to_string(number));
    alarm.active = true;
    alarm.since_ns = kNow;
    return {AlarmEvent::raised, alarm};
  }
  static std::vector<health::GpsOutageBook> books(std::uint32_t count) {
    return {{"gps", {true, kNow, count, 0, 0}}};
  }
  [[nodiscard]] std::vector<std::string> events() const {
    std::vector<std::string> out;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);)
      out.push_back(nlohmann::json::parse(line)["event"].get<std::string>());
    return out;
  }

  std::filesystem::path folder;
  std::string path;
  TestClock clock;
  runtime::Log log{"test", runtime::LogLevel::error};
};

TEST_F(RecordKeeperTest, WritesInOrderAndHandsOutWhatWasLatched) {
  {
    RecordKeeper keeper(path, "auv", clock, log);
    EXPECT_TRUE(keeper.books_of_before().empty());
    EXPECT_TRUE(keeper.take_latched().empty());
    for (int i = 0; i < 5; ++i) keeper.append(raised(i), kNow + i);
    keeper.keep(books(3));
    keeper.finish();
  }
  EXPECT_EQ(events(), (std::vector<std::string>{"started", "raised", "raised", "raised", "raised", "raised",
                                                "stopped"}));
  RecordKeeper again(path, "auv", clock, log);
  ASSERT_EQ(again.books_of_before().size(), 1U);
  EXPECT_EQ(again.books_of_before()[0].record.count, 3U);
  const auto latched = again.take_latched();
  ASSERT_EQ(latched.size(), 5U);
  EXPECT_EQ(latched[4].alarm, Name("alarm4"));
  EXPECT_TRUE(again.take_latched().empty()) << "once";
}

TEST_F(RecordKeeperTest, NobodyWaitsForADiskThatHangsAndWhatIsDroppedIsCountedAndSaid) {
  // A file that nobody reads hangs whoever opens it to write.
  const std::string hanging = path + ".outages.new";
  ASSERT_EQ(mkfifo(hanging.c_str(), 0600), 0);
  int reader = -1;
  {
    RecordKeeper keeper(path, "auv", clock, log);
    keeper.keep(books(1));
    ASSERT_TRUE(test::wait_until([&] { return clock.read_elsewhere(); }, kPatience_s));
    EXPECT_EQ(keeper.state().trouble, "");
    clock.advance(4 * kNsPerSecond);
    EXPECT_EQ(keeper.state().trouble, "") << "a card that tidies itself up";
    clock.run_at(20.0);
    clock.advance(90 * kNsPerSecond);
    EXPECT_EQ(keeper.state().trouble, "") << "these are less than five seconds of the host";
    clock.run_at(1.0);
    EXPECT_NE(keeper.state().trouble.find("does not answer"), std::string::npos) << keeper.state().trouble;
    constexpr int kTooMany = 7;
    for (int i = 0; i < static_cast<int>(RecordKeeper::kMostLines) + kTooMany; ++i)
      keeper.append(raised(i), kNow + i);
    EXPECT_EQ(keeper.state().dropped, static_cast<std::uint64_t>(kTooMany));
    EXPECT_EQ(events(), std::vector<std::string>{"started"});
    reader = ::open(hanging.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    ASSERT_GE(reader, 0);
    const std::size_t all = RecordKeeper::kMostLines + 2;  // and two of its own
    ASSERT_TRUE(test::wait_until([&] { return keeper.state().journal.lines >= all; }, kPatience_s));
    EXPECT_EQ(keeper.state().trouble, "");
  }
  ::close(reader);
  const auto lines = events();
  ASSERT_EQ(lines.size(), RecordKeeper::kMostLines + 2);
  EXPECT_EQ(lines[RecordKeeper::kMostLines], "raised");
  EXPECT_EQ(lines.back(), "dropped");
}

TEST_F(RecordKeeperTest, AJournalThatCannotBeIsATroubleAndStopsNobody) {
  RecordKeeper keeper("/dev/null", "auv", clock, log);
  EXPECT_NE(keeper.state().trouble.find("regular file"), std::string::npos);
  keeper.append(raised(1), kNow);
  ASSERT_TRUE(test::wait_until([&] { return keeper.state().journal.failures > 0; }, kPatience_s));
  EXPECT_NE(keeper.state().trouble.find("regular file"), std::string::npos);
}

TEST(OutageFile, DoesNotWaitForAPipe) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "journal.outages").c_str(), 0600), 0);
  OutageFile file(folder / "journal");
  EXPECT_TRUE(file.read("auv").empty());
  EXPECT_NE(file.error().find("is a pipe, expected a regular file"), std::string::npos) << file.error();
}

}  // namespace
}  // namespace fathom::monitor
