// The recorder as a service and as a command, over real DDS.

#include <atomic>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "base/clock.hpp"
#include "blackbox/store.hpp"
#include "bus/cdr.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "record/reader.hpp"
#include "record/recover.hpp"
#include "record/writer.hpp"
#include "samples/imu.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kDomain = 222;

/// An inertial unit at 400 Hz, and an alarm.
class Vehicle {
 public:
  Vehicle() : participant_(presence(kDomain, "imu_bridge")), imu_(participant_), alarms_(participant_) {
    Alarm alarm;
    alarm.header = header(0);
    alarm.alarm = "gps_outage";
    alarm.active = true;
    alarm.text = "GPS is gone";
    alarms_.write(alarm);
    thread_ = std::thread([this] {
      auto next = std::chrono::steady_clock::now();
      while (!stop_) {
        ImuSample sample;
        sample.header = header(++sequence_);
        imu_.write(sample);
        next += std::chrono::microseconds(2500);
        std::this_thread::sleep_until(next);
      }
    });
  }
  ~Vehicle() {
    stop_ = true;
    thread_.join();
  }
  [[nodiscard]] bool heard() const { return imu_.matched_readers() > 0; }
  [[nodiscard]] std::uint64_t sequence() const { return sequence_; }

 private:
  SampleHeader header(std::uint64_t sequence) {
    const TimeNs now = clock_.utc_ns();
    return {"auv", "imu", now, now, sequence};
  }
  SystemClock clock_;
  bus::Participant participant_;
  bus::Writer<ImuSample> imu_;
  bus::Writer<Alarm> alarms_;
  std::atomic<std::uint64_t> sequence_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

std::vector<std::string> recorder_arguments(const std::string& folder,
                                            const std::vector<std::string>& sets = {}) {
  std::vector<std::string> out{"--config", source_dir() + "/deploy/config/recorder.json",
                               "--set",    "bus.domain=" + std::to_string(kDomain),
                               "--set",    "clock.anchor_file=",
                               "--set",    "folder=" + folder};
  for (const std::string& set : sets) {
    out.emplace_back("--set");
    out.push_back(set);
  }
  return out;
}

struct Recorded {
  std::vector<std::uint64_t> imu;
  std::map<std::string, std::size_t> topics;
  std::vector<std::string> problems;
  std::vector<std::string> attachments;
  std::size_t events = 0;
};

Recorded read(const std::filesystem::path& path) {
  Recorded out;
  auto reader = record::Reader::open(path);
  EXPECT_TRUE(reader) << reader.error().message;
  if (!reader) return out;
  out.problems = reader.value().check().problems;
  reader.value().read({}, [&](const record::Channel& channel, const record::Message& message) {
    ++out.topics[channel.topic];
    if (channel.topic == "fathom/v1/imu") {
      const auto sample = bus::from_cdr<ImuSample>(message.data);
      EXPECT_TRUE(sample.has_value());
      EXPECT_EQ(channel.metadata.at("writer"), "imu_bridge");
      if (sample) out.imu.push_back(sample->header.sequence);
      EXPECT_LE(std::abs(message.log_time - sample->header.stamp_ns), kNsPerSecond);
      EXPECT_LE(message.publish_time, message.log_time);
    }
    return true;
  });
  for (const auto& one : reader.value().contents().attachments) out.attachments.push_back(one.name);
  for (const auto& one : reader.value().contents().metadata) out.events += one.name == "event" ? 1 : 0;
  return out;
}

/// The number that samples without a gap have; their last one.
std::uint64_t last_of(const std::vector<std::uint64_t>& numbers) {
  for (std::size_t i = 1; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], numbers[i - 1] + 1);
  return numbers.empty() ? 0 : numbers.back();
}

TEST(Recorder, KeepsEverySampleWithItsOrigin) {
  const TemporaryFolder folder;
  const Vehicle vehicle;
  {
    Process recorder("fathom-recorder", recorder_arguments(folder.path().string()));
    ASSERT_TRUE(wait_until([&] { return vehicle.heard(); })) << recorder.err();
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    recorder.kill(SIGTERM);
    EXPECT_EQ(recorder.wait(), 0) << recorder.err();
  }
  const auto files = blackbox::recordings_in(folder.path());
  ASSERT_EQ(files.size(), 1U);
  const Recorded recorded = read(files[0]);
  EXPECT_TRUE(recorded.problems.empty()) << recorded.problems.front();
  EXPECT_GT(recorded.imu.size(), 300U);
  last_of(recorded.imu);
  EXPECT_EQ(recorded.topics.count("fathom/v1/alarm"), 1U) << "latched, written before the recorder was there";
  EXPECT_GE(recorded.topics.at("fathom/v1/service_status"), 1U) << "its own life sign";
  EXPECT_EQ(recorded.events, 1U);
  for (const char* name : {"services/recorder/command.json", "services/recorder/config.json",
                           "services/recorder/process.json", "qos/samples.xml", "qos/nav_state.xml"}) {
    EXPECT_EQ(std::count(recorded.attachments.begin(), recorded.attachments.end(), name), 1) << name;
  }
}

TEST(Recorder, LosesAtMostASecondWhenItIsKilled) {
  const TemporaryFolder folder;
  const Vehicle vehicle;
  std::mt19937 random(1);
  for (int i = 0; i < 6; ++i) {
    std::uint64_t at_kill = 0;
    {
      Process recorder("fathom-recorder", recorder_arguments(folder.path().string()));
      ASSERT_TRUE(wait_until([&] { return vehicle.heard(); })) << recorder.err();
      std::this_thread::sleep_for(std::chrono::milliseconds(1200 + random() % 700));
      at_kill = vehicle.sequence();
      recorder.kill(SIGKILL);
      (void)recorder.wait();
    }
    ASSERT_TRUE(wait_until([&] { return !vehicle.heard(); }, 30.0));
    const auto files = blackbox::recordings_in(folder.path());
    ASSERT_EQ(files.size(), static_cast<std::size_t>(i + 1));
    const Recorded cut = read(files.back());  // as it was left
    EXPECT_GE(last_of(cut.imu) + 400, at_kill);
    EXPECT_FALSE(cut.problems.empty());
    if (i % 2 == 1) {  // the others are closed by the next start
      const auto recovery = record::recover(files.back());
      ASSERT_TRUE(recovery) << recovery.error().message;
    }
    if (i > 0) {
      const Recorded before = read(files[files.size() - 2]);
      EXPECT_TRUE(before.problems.empty()) << before.problems.front();
    }
  }
}

TEST(Recorder, SaysThatItCannotWriteAndLivesOn) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "no folder";
  const Vehicle vehicle;
  bus::Participant participant(presence(kDomain, "monitor"));
  std::atomic<bool> degraded = false;
  const bus::Reader<ServiceStatus> reader(participant, [&](const ServiceStatus& status, const auto&) {
    if (status.header.sensor.view() == "recorder" && status.state == ServiceState::degraded &&
        status.text.find("nothing is recorded") != std::string::npos && status.counter("samples_lost") > 100)
      degraded = true;
  });
  Process recorder("fathom-recorder", recorder_arguments(folder / "file"));
  EXPECT_TRUE(wait_until([&] { return degraded.load(); })) << recorder.err();
  recorder.kill(SIGTERM);
  EXPECT_EQ(recorder.wait(), 0);
  EXPECT_NE(recorder.err().find("cannot be written"), std::string::npos) << recorder.err();
}

TEST(Recorder, RefusesATopicThatIsNone) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments =
      recorder_arguments(folder / "recordings", {R"(topics=["fathom/v1/nav_state", "fathom/v1/nav_stat"])"});
  arguments.emplace_back("--check");
  Process recorder("fathom-recorder", arguments);
  EXPECT_EQ(recorder.wait(), 2);
  EXPECT_NE(recorder.err().find("topics.1: is \"fathom/v1/nav_stat\", expected one of "), std::string::npos)
      << recorder.err();
  EXPECT_NE(recorder.err().find("; the nearest is fathom/v1/nav_state"), std::string::npos);
  arguments[arguments.size() - 2] = R"(topics=["fathom/v1/nav_state"])";
  Process right("fathom-recorder", arguments);
  EXPECT_EQ(right.wait(), 0) << right.err();
}

std::vector<std::string> explain_arguments(const std::string& listen_s) {
  return {"explain", "--live", "--domain", std::to_string(kDomain), "--listen", listen_s, "--json"};
}

TEST(ExplainCommand, ReadsWhatTheRecorderOfThisHostIsWriting) {
  const TemporaryFolder folder;
  const Vehicle vehicle;
  Process recorder("fathom-recorder", recorder_arguments(folder.path().string()));
  ASSERT_TRUE(wait_until([&] { return vehicle.heard(); })) << recorder.err();
  std::this_thread::sleep_for(std::chrono::milliseconds(4000));
  Process explain("fathom", explain_arguments("300"));
  EXPECT_LE(explain.wait(), 1) << explain.err();
  EXPECT_NE(explain.err().find(folder.path().string()), std::string::npos) << explain.err();
  EXPECT_NE(explain.out().find("gps_outage"), std::string::npos) << "the alarm: " << explain.out();
}

TEST(ExplainCommand, ListensWhereThereIsNoRecorder) {
  const Vehicle vehicle;
  Process explain("fathom", explain_arguments("6"));
  EXPECT_LE(explain.wait(), 1) << explain.err();
  EXPECT_NE(explain.err().find("No recorder on this host"), std::string::npos) << explain.err();
  EXPECT_NE(explain.out().find("gps_outage"), std::string::npos) << explain.out();
}

TEST(RecordCommand, RecordsForAWhileAndRecovers) {
  const TemporaryFolder folder;
  const std::string file = folder / "by_hand.mcap";
  const Vehicle vehicle;
  {
    Process record("fathom", {"record", "--domain", std::to_string(kDomain), "--duration", "2", "--topic",
                              "imu", "--profiles", source_dir() + "/deploy/dds", "--out", file});
    EXPECT_EQ(record.wait(), 0) << record.err();
    EXPECT_NE(record.out().find(" messages, "), std::string::npos) << record.out();
  }
  const Recorded recorded = read(file);
  EXPECT_GT(recorded.imu.size(), 300U);
  last_of(recorded.imu);
  EXPECT_EQ(recorded.topics.size(), 1U);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) * 2 / 3);
  Process recover("fathom", {"record", "--recover", file});
  EXPECT_EQ(recover.wait(), 0) << recover.err();
  const Recorded after = read(file);
  EXPECT_TRUE(after.problems.empty());
  EXPECT_GT(after.imu.size(), 50U);
  // Closed, and a byte of its first chunk is another one.
  {
    std::fstream bytes(file, std::ios::binary | std::ios::in | std::ios::out);
    bytes.seekg(2'000);
    const char other = static_cast<char>(bytes.peek() ^ 0x20);
    bytes.seekp(2'000);
    bytes.put(other);
  }
  Process damaged("fathom", {"record", "--recover", file});
  EXPECT_EQ(damaged.wait(), 3) << damaged.out();
  EXPECT_NE(damaged.err().find("is closed but damaged"), std::string::npos) << damaged.err();
}

TEST(RecordCommand, EndsWithFourWhereTheDiskDoesNotTakeEverything) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "no folder";
  const Vehicle vehicle;
  const std::string arguments = " record --domain " + std::to_string(kDomain) +
                                " --duration 2 --topic imu --profiles " + source_dir() +
                                "/deploy/dds --compression none --out " + folder.path().string();
  const std::string record = binary_dir() + "/bin/fathom" + arguments;
  Process nowhere("/bin/sh", {"-c", "exec " + record + "/file/by_hand.mcap"});
  EXPECT_EQ(nowhere.wait(), 4) << nowhere.out() << nowhere.err();
  // A file of 32 kB is as far as it gets, as on a disk that is full.
  Process full("/bin/sh", {"-c", "trap '' XFSZ; ulimit -f 64; exec " + record + "/by_hand.mcap"});
  EXPECT_EQ(full.wait(), 4) << full.out() << full.err();
  EXPECT_NE(full.err().find("cannot be written"), std::string::npos) << full.err();
}

/// A recording of 100 inertial samples, 5 ms apart, and of as many depths.
void write_recording(const std::string& path) {
  auto sink = record::FileSink::create(path);
  ASSERT_TRUE(sink);
  record::Writer writer(std::move(sink.value()), {});
  std::string why = writer.begin();
  const auto imu = writer.add_channel(0, "fathom/v1/imu", "cdr");
  const auto nav = writer.add_channel(0, "fathom/v1/nav_state", "cdr");
  const auto strange = writer.add_channel(0, "rt/other", "cdr");
  for (std::uint32_t i = 1; i <= 100; ++i) {
    const TimeNs now = 1'700'000'000 * kNsPerSecond + i * 5 * kNsPerMillisecond;
    ImuSample sample;
    sample.header = {"auv", "imu", now, now, i};
    NavState state;
    state.header = {"auv", "fusion", now, now, i};
    why += writer.write({imu, i, now, now, bus::to_cdr(sample)});
    why += writer.write({nav, i, now, now, bus::to_cdr(state)});
    why += writer.write({strange, i, now, now, bus::to_cdr(state)});
  }
  why += writer.finish();
  ASSERT_EQ(why, "");
}

TEST(ReplayCommand, PublishesWhatIsAskedForInItsOrderAndTime) {
  const TemporaryFolder folder;
  const std::string file = folder / "r.mcap";
  write_recording(file);
  bus::Participant participant(presence(kDomain, "listener"));
  std::mutex mutex;
  std::vector<ImuSample> heard;
  std::vector<TimeNs> at;
  std::atomic<int> states = 0;
  const bus::Reader<ImuSample> imu(participant, [&](const ImuSample& sample, const auto&) {
    const std::lock_guard lock(mutex);
    heard.push_back(sample);
    at.push_back(SystemClock().monotonic_ns());
  });
  const bus::Reader<NavState> nav(participant, [&](const NavState&, const auto&) { ++states; });
  const auto replay = [&](std::vector<std::string> more) {
    std::vector<std::string> words{
        "replay", file, "--domain", std::to_string(kDomain), "--profiles", source_dir() + "/deploy/dds"};
    words.insert(words.end(), more.begin(), more.end());
    Process process("fathom", words);
    EXPECT_EQ(process.wait(), 0) << process.err() << process.out();
    const std::lock_guard lock(mutex);
    return std::exchange(heard, {});
  };
  const auto sensors = replay({"--sensors-only", "--rename", "auv=ghost"});
  EXPECT_EQ(states, 0);
  ASSERT_EQ(sensors.size(), 100U);
  for (std::size_t i = 0; i < sensors.size(); ++i) EXPECT_EQ(sensors[i].header.sequence, i + 1);
  EXPECT_EQ(sensors[0].header.vehicle.view(), "ghost");
  EXPECT_GT(at.back() - at.front(), 400 * kNsPerMillisecond);
  const auto part = replay({"--from", "0.1", "--to", "0.2", "--speed", "0", "--now"});
  ASSERT_EQ(part.size(), 20U);
  EXPECT_EQ(part[0].header.sequence, 21U);
  EXPECT_LT(std::abs(part[0].header.stamp_ns - SystemClock().utc_ns()), 10 * kNsPerSecond);
  EXPECT_GT(states, 0);
}

}  // namespace
}  // namespace fathom::test
