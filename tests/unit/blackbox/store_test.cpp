// What the disk's thread makes of samples: files, splits, quota, events, a full disk. No disk, no time.

#include "blackbox/store.hpp"

#include <filesystem>
#include <fstream>
#include <map>

#include <gtest/gtest.h>

#include "blackbox/queue.hpp"
#include "blackbox/surroundings.hpp"
#include "record/reader.hpp"
#include "record/recover.hpp"
#include "support/failing_readdir.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using blackbox::Event;
using blackbox::Options;
using blackbox::Origin;
using blackbox::Sample;
using blackbox::Store;

constexpr TimeNs kBegin = 1'700'000'000 * kNsPerSecond;

/// Disks that are files in memory, and may be full.
struct Disk {
  struct Sink final : record::Sink {
    Sink(Disk& disk_in, record::Bytes& bytes_in) : disk(disk_in), bytes(bytes_in) {}
    std::string append(record::View more) override {
      if (!disk.trouble.empty()) return disk.trouble;
      bytes.insert(bytes.end(), more.begin(), more.end());
      return {};
    }
    std::string sync() override { return {}; }
    std::uint64_t size() const override { return bytes.size(); }
    bool is_at(const std::filesystem::path& /*path*/) const override { return !disk.is_covered; }
    Disk& disk;
    record::Bytes& bytes;
  };
  Store::Create create() {
    return [this](const std::filesystem::path& path) -> Result<std::unique_ptr<record::Sink>> {
      if (!trouble.empty()) return Error{path.string() + ": " + trouble};
      return std::unique_ptr<record::Sink>(std::make_unique<Sink>(*this, files[path.filename().string()]));
    };
  }
  Store::Say say() {
    return [this](bool is_trouble, const std::string& line) {
      if (is_trouble) said.push_back(line);
    };
  }
  std::map<std::string, record::Bytes> files;
  std::string trouble;
  bool is_covered = false;  ///< another disk is mounted over it
  std::vector<std::string> said;
};

struct Read {
  std::vector<std::string> messages;  ///< topic:first byte
  record::Contents contents;
  std::vector<std::string> texts;  ///< of metadata
};

Read read(const record::Bytes& bytes) {
  auto reader = record::Reader::open(std::make_unique<record::MemorySource>(bytes));
  EXPECT_TRUE(reader) << reader.error().message;
  EXPECT_TRUE(reader.value().check().problems.empty());
  Read out;
  reader.value().read({}, [&](const record::Channel& channel, const record::Message& message) {
    out.messages.push_back(channel.topic + ":" + std::to_string(message.data.front()));
    return true;
  });
  out.contents = reader.value().contents();
  for (const auto& index : out.contents.metadata) {
    const auto metadata = reader.value().metadata(index);
    for (const auto& [key, value] : metadata.value().metadata) out.texts.push_back(key + "=" + value);
  }
  return out;
}

Sample sample(std::uint32_t origin, double at_s, std::uint8_t byte, const std::string& key = "") {
  const TimeNs time = kBegin + from_seconds(at_s);
  return {origin, time, time, record::Bytes(100, byte), key};
}

Options in(const std::string& folder) {
  Options options;
  options.out = folder;
  options.compression = record::Compression::none;
  options.quota_bytes = 0;
  return options;
}

void add_origins(Store& store) {
  store.add(Origin{"a", "fathom::v1::ImuSample", "imu_bridge", "01", false});
  store.add(Origin{"latched", "fathom::v1::Alarm", "monitor", "02", true});
}

TEST(Store, RepeatsLatchedSamplesAndEnclosuresInEveryFile) {
  Disk disk;
  Options options = in("/nowhere");
  options.split_ns = 10 * kNsPerSecond;
  Store store(options, disk.create(), disk.say());
  add_origins(store);
  store.add(blackbox::Enclosure{"config", "application/json", kBegin, {'{', '}'}});
  store.add(sample(1, 0.0, 10, "gps"));
  store.add(sample(1, 0.1, 11, "gps"));
  store.add(sample(1, 0.2, 20, "dvl"));
  store.add(sample(0, 0.3, 1));
  store.settle(kBegin + 9 * kNsPerSecond);
  store.add(sample(0, 9.5, 2));
  store.settle(kBegin + 11 * kNsPerSecond);
  store.add(sample(0, 12.0, 3));
  store.finish();
  ASSERT_EQ(disk.files.size(), 2U);
  const Read first = read(disk.files.begin()->second);
  const Read second = read(disk.files.rbegin()->second);
  EXPECT_EQ(first.messages,
            (std::vector<std::string>{"latched:10", "latched:11", "latched:20", "a:1", "a:2"}));
  EXPECT_EQ(second.messages, (std::vector<std::string>{"latched:20", "latched:11", "a:3"}));
  for (const Read& one : {first, second}) {
    ASSERT_EQ(one.contents.attachments.size(), 1U);
    for (const auto& [id, channel] : one.contents.channels) {
      EXPECT_EQ(channel.message_encoding, "cdr");
      EXPECT_EQ(channel.metadata.at("writer"), channel.topic == "a" ? "imu_bridge" : "monitor");
      EXPECT_EQ(one.contents.schemas.at(channel.schema_id).encoding, "omgidl");
    }
  }
  EXPECT_EQ(store.counts().files, 2U);
  EXPECT_EQ(store.counts().samples, 8U);
}

TEST(Store, EnclosesAFileThatChangesOnceItIsThere) {
  Disk disk;
  const test::TemporaryFolder folder;
  const std::string checkpoint = folder / "checkpoint";
  Store store(in("/nowhere"), disk.create(), disk.say());
  add_origins(store);
  store.add(blackbox::Enclosure{"checkpoint", "application/octet-stream", kBegin, {}, checkpoint});
  store.add(sample(0, 0.3, 1));
  store.settle(kBegin + 4 * kNsPerSecond);
  std::ofstream(checkpoint) << "state";
  for (int s = 5; s < 20; ++s) store.settle(kBegin + s * kNsPerSecond);
  store.finish();
  const Read all = read(disk.files.begin()->second);
  ASSERT_EQ(all.contents.attachments.size(), 1U) << "once";
  EXPECT_EQ(all.contents.attachments.front().name, "checkpoint");
}

TEST(Store, SplitsBySize) {
  Disk disk;
  Options options = in("/nowhere");
  options.split_bytes = 20'000;
  Store store(options, disk.create(), disk.say());
  add_origins(store);
  for (int i = 0; i < 1000; ++i) {
    store.add(sample(0, 0.01 * i, 1));
    if (i % 10 == 0) store.settle(kBegin + i * 10 * kNsPerMillisecond);
  }
  store.finish();
  EXPECT_GE(disk.files.size(), 5U);
  std::size_t messages = 0;
  for (const auto& [name, bytes] : disk.files) {
    EXPECT_LT(bytes.size(), 30'000U);
    messages += read(bytes).messages.size();
  }
  EXPECT_EQ(messages, 1000U);
}

TEST(Store, AFullDiskIsCountedAndToldInTheFile) {
  Disk disk;
  Store store(in("/nowhere"), disk.create(), disk.say());
  add_origins(store);
  store.add(sample(0, 0.0, 1));
  store.settle(kBegin);
  disk.trouble = "No space left on device";
  store.add(sample(0, 1.0, 2));
  store.add(sample(0, 1.1, 3));
  store.settle(kBegin + 2 * kNsPerSecond);
  EXPECT_EQ(store.counts().lost, 2U);
  EXPECT_EQ(store.counts().trouble, disk.trouble);
  disk.trouble.clear();
  store.add(sample(0, 3.0, 4));
  store.settle(kBegin + 3 * kNsPerSecond);
  store.finish();
  EXPECT_TRUE(store.counts().trouble.empty());
  const Read file = read(disk.files.begin()->second);
  EXPECT_EQ(file.messages, (std::vector<std::string>{"a:1", "a:4"}));
  ASSERT_EQ(file.texts.size(), 1U);
  EXPECT_TRUE(file.texts[0].starts_with("a=2 samples from 2023-11-14T")) << file.texts[0];
}

TEST(Store, BeginsWhenTheDiskIsThereAgain) {
  Disk disk;
  disk.trouble = "Read-only file system";
  Store store(in("/nowhere"), disk.create(), disk.say());
  add_origins(store);
  for (int i = 0; i < 50; ++i) store.add(sample(0, 0.1 * i, 1));
  EXPECT_EQ(store.counts().lost, 50U);
  EXPECT_EQ(disk.said.size(), 1U) << "said once";
  disk.trouble.clear();
  for (int i = 50; i < 100; ++i) store.add(sample(0, 0.1 * i, 2));
  store.settle(kBegin + 10 * kNsPerSecond);
  store.finish();
  ASSERT_EQ(disk.files.size(), 1U);
  EXPECT_GE(read(disk.files.begin()->second).messages.size(), 25U);
}

TEST(Store, GoesOnWhereAnotherDiskIsPutInThePlaceOfOneThatFails) {
  Disk disk;
  Store store(in("/nowhere"), disk.create(), disk.say());
  add_origins(store);
  store.add(sample(0, 0.0, 1));
  store.settle(kBegin);
  disk.trouble = "Read-only file system";
  store.add(sample(0, 1.0, 2));
  store.settle(kBegin + kNsPerSecond);
  EXPECT_EQ(disk.files.size(), 1U);
  disk.trouble.clear();
  disk.is_covered = true;
  store.settle(kBegin + 2 * kNsPerSecond);
  EXPECT_EQ(disk.files.size(), 1U) << "what can be written is written on";
  disk.trouble = "Read-only file system";
  store.add(sample(0, 3.0, 3));
  store.settle(kBegin + 3 * kNsPerSecond);
  disk.trouble.clear();
  disk.is_covered = false;
  store.add(sample(0, 6.0, 4));
  store.settle(kBegin + 6 * kNsPerSecond);
  ASSERT_EQ(disk.files.size(), 2U);
  EXPECT_EQ(store.counts().trouble, "");
  store.finish();
  EXPECT_EQ(read(disk.files.rbegin()->second).messages, std::vector<std::string>{"a:4"});
}

TEST(FileSink, KnowsWhetherAPathStillNamesIt) {
  const test::TemporaryFolder folder;
  const auto sink = record::FileSink::create(folder / "a.mcap");
  ASSERT_TRUE(sink);
  EXPECT_TRUE(sink.value()->is_at(folder / "a.mcap"));
  std::filesystem::rename(folder / "a.mcap", folder / "b.mcap");
  EXPECT_FALSE(sink.value()->is_at(folder / "a.mcap"));
  std::ofstream(folder / "a.mcap") << "another";
  EXPECT_FALSE(sink.value()->is_at(folder / "a.mcap"));
  EXPECT_TRUE(sink.value()->is_at(folder / "b.mcap"));
}

TEST(Store, BeginsAnewWhereSomebodyRemovesTheFile) {
  const test::TemporaryFolder folder;
  std::vector<std::string> said;
  Store store(in(folder / "records"), blackbox::create_file, [&](bool is_trouble, const std::string& line) {
    if (is_trouble) said.push_back(line);
  });
  add_origins(store);
  for (int i = 0; i < 10; ++i) store.add(sample(0, 0.1 * i, 1));
  store.settle(kBegin + kNsPerSecond);
  std::filesystem::remove_all(folder / "records");
  for (int i = 10; i < 20; ++i) store.add(sample(0, 0.1 * i, 2));
  store.settle(kBegin + 2 * kNsPerSecond);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("the file was removed while it was written, and 20 samples with it"),
            std::string::npos)
      << said[0];
  EXPECT_EQ(store.counts().lost, 20U);
  for (int i = 20; i < 30; ++i) store.add(sample(0, 0.1 * i, 3));
  store.settle(kBegin + 3 * kNsPerSecond);
  EXPECT_EQ(store.counts().trouble, "");
  store.finish();
  const auto files = blackbox::recordings_in(folder / "records");
  ASSERT_EQ(files.size(), 1U);
  auto reader = record::Reader::open(files.front());
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader.value().contents().statistics.message_count, 10U);
  ASSERT_EQ(reader.value().contents().metadata.size(), 1U);
  EXPECT_EQ(reader.value().contents().metadata[0].name, "dropped");
}

TEST(Store, TellsInTheFileWhatTheQueueDropped) {
  Disk disk;
  Store store(in("/nowhere"), disk.create(), disk.say());
  add_origins(store);
  store.add(sample(0, 0.0, 1));
  store.add_dropped({{"a", {7, kBegin, kBegin + 5}}});
  store.settle(kBegin);
  store.finish();
  const Read file = read(disk.files.begin()->second);
  ASSERT_EQ(file.texts.size(), 1U);
  EXPECT_TRUE(file.texts[0].starts_with("a=7 samples from "));
  EXPECT_EQ(store.counts().lost, 7U);
}

TEST(Store, KeepsWhatIsAroundAnEventAndNothingElse) {
  Disk disk;
  Options options = in("/nowhere");
  options.around_events = true;
  options.before_ns = 5 * kNsPerSecond;
  options.after_ns = 10 * kNsPerSecond;
  Store store(options, disk.create(), disk.say());
  add_origins(store);
  for (int s = 0; s < 100; ++s) {
    store.add(sample(0, s, static_cast<std::uint8_t>(s)));
    if (s == 40) store.add(Event{kBegin + 40 * kNsPerSecond, "alarm", "gps_outage began"});
    store.settle(kBegin + s * kNsPerSecond);
  }
  store.finish();
  ASSERT_EQ(disk.files.size(), 1U);
  const Read file = read(disk.files.begin()->second);
  std::vector<std::string> expected;
  for (int s = 35; s <= 50; ++s) expected.push_back("a:" + std::to_string(s));
  EXPECT_EQ(file.messages, expected);
  EXPECT_EQ(file.texts.size(), 4U);
}

TEST(Store, RemovesTheOldestForTheQuota) {
  const test::TemporaryFolder folder;
  for (const char* name : {"fathom-1.mcap", "fathom-2.mcap", "fathom-3.mcap", "other.mcap"}) {
    std::ofstream(folder / name) << std::string(1000, 'x');
  }
  Disk disk;
  Options options = in(folder.path().string());
  options.split_bytes = 1000;
  options.quota_bytes = 2500;
  Store store(options, disk.create(), disk.say());
  add_origins(store);
  store.add(sample(0, 0.0, 1));
  store.finish();
  EXPECT_FALSE(std::filesystem::exists(folder / "fathom-1.mcap"));
  EXPECT_FALSE(std::filesystem::exists(folder / "fathom-2.mcap"));
  EXPECT_TRUE(std::filesystem::exists(folder / "fathom-3.mcap"));
  EXPECT_TRUE(std::filesystem::exists(folder / "other.mcap")) << "not ours";
  EXPECT_EQ(store.counts().removed, 2U);
}

TEST(Store, AFolderThatTheDiskFailsInIsReadAsFarAsItGoes) {
  const test::TemporaryFolder folder;
  for (int i = 0; i < 9; ++i) std::ofstream(folder / ("fathom-" + std::to_string(i) + ".mcap")) << "1";
  const std::string profiles = test::source_dir() + "/deploy/dds";
  const std::size_t all = blackbox::qos_profiles(profiles, kBegin).size();
  constexpr int kSome = 4;  // "." and ".." may be among them
  test::entries_until_failure = kSome;
  EXPECT_LT(blackbox::recordings_in(folder.path()).size(), 9U);
  test::entries_until_failure = kSome;
  EXPECT_LT(blackbox::qos_profiles(profiles, kBegin).size(), all);
  test::entries_until_failure = -1;
  EXPECT_EQ(blackbox::recordings_in(folder.path()).size(), 9U);
}

TEST(Queue, DropsWhatFindsNoRoomAndCountsIt) {
  blackbox::Queue queue(1000);
  const std::uint32_t origin = queue.add({"a", "A", "w", "01", false});
  for (int i = 0; i < 10; ++i) queue.put(sample(origin, i, 1));  // 228 bytes each
  EXPECT_EQ(queue.dropped(), 6U);
  auto batch = queue.take(0);
  EXPECT_EQ(batch.items.size(), 5U);
  ASSERT_EQ(batch.dropped.size(), 1U);
  EXPECT_EQ(batch.dropped.at("a").count, 6U);
  EXPECT_EQ(batch.dropped.at("a").first_ns, kBegin + 4 * kNsPerSecond);
  EXPECT_EQ(batch.dropped.at("a").last_ns, kBegin + 9 * kNsPerSecond);
  queue.put(sample(origin, 20, 1));
  queue.end();
  batch = queue.take(kNsPerSecond * 3600);
  EXPECT_TRUE(batch.ended);
  EXPECT_EQ(batch.items.size(), 1U);
  EXPECT_TRUE(batch.dropped.empty());
}

TEST(Queue, EventsAndEnclosuresFindALittleMoreRoomAndNoMore) {
  blackbox::Queue queue(1000);
  const std::uint32_t origin = queue.add({"a", "A", "w", "01", false});
  for (int i = 0; i < 10; ++i) queue.put(sample(origin, i, 1));
  for (int i = 0; i < 1000; ++i) queue.put(Event{kBegin + i, "order", "reset"});
  for (int i = 0; i < 1000; ++i) queue.put(blackbox::Enclosure{"e", "text/plain", kBegin + i, {1, 2, 3}});
  EXPECT_GT(queue.dropped(), 1990U);
  const auto batch = queue.take(0);
  EXPECT_GT(batch.items.size(), 5U);
  EXPECT_LT(batch.items.size(), 10U);
  EXPECT_EQ(batch.dropped.at("a").count, 6U);
  EXPECT_EQ(batch.dropped.at("events").last_ns, kBegin + 999);
  EXPECT_EQ(batch.dropped.at("events").count + batch.dropped.at("enclosures").count + 6, queue.dropped());
}

TEST(FileSink, IsNotRecoveredWhileItIsWritten) {
  const test::TemporaryFolder folder;
  auto sink = blackbox::create_file(folder / "live.mcap");
  ASSERT_TRUE(sink);
  record::Writer writer(std::move(sink.value()), {});
  ASSERT_EQ(writer.begin(), "");
  ASSERT_EQ(writer.write({writer.add_channel(0, "a", "cdr"), 1, 1, 1, {}}), "");
  ASSERT_EQ(writer.flush(), "");
  const auto recovery = record::recover(folder / "live.mcap");
  ASSERT_FALSE(recovery);
  EXPECT_NE(recovery.error().message.find("somebody is writing it now"), std::string::npos);
  ASSERT_EQ(writer.finish(), "");
}

}  // namespace
}  // namespace fathom
