// Files that end anywhere, and files with wrong bits.

#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "made_file.hpp"
#include "record/file.hpp"
#include "record/recover.hpp"
#include "record/wire.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using record::Bytes;
using record::Compression;
using test::made_file;
using test::Said;

void save(const std::string& path, const Bytes& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// Messages in chunks that lie whole within the first `size` bytes.
std::size_t messages_within(const Bytes& whole, std::size_t size) {
  auto reader = test::reader_of(whole);
  std::size_t count = 0;
  for (const auto& chunk : reader.value().contents().chunks) {
    if (chunk.chunk_start_offset + chunk.chunk_length > size) break;
    for (const auto& [channel, offset] : chunk.message_index_offsets) {
      const record::View content(whole.data() + offset + record::kRecordHead,
                                 whole.size() - offset - record::kRecordHead);
      count += record::parse<record::MessageIndex>(content).value().records.size();
    }
  }
  return count;
}

TEST(Truncation, AtEveryByteLeavesEveryWholeChunkReadable) {
  const auto made = made_file(11, Compression::zstd, 60, 400);
  std::size_t refused = 0;
  for (std::size_t size = 0; size < made.bytes.size(); ++size) {
    const Bytes cut(made.bytes.begin(), made.bytes.begin() + static_cast<std::ptrdiff_t>(size));
    auto reader = test::reader_of(cut);
    if (!reader) {
      ++refused;
      EXPECT_LT(size, 40U) << reader.error().message;  // within magic and header
      continue;
    }
    record::Outcome outcome;
    const auto said = test::read_all(reader.value(), outcome);
    ASSERT_EQ(said.size(), messages_within(made.bytes, size)) << "cut at " << size;
    ASSERT_TRUE(std::equal(said.begin(), said.end(), made.said.begin()));
    EXPECT_FALSE(reader.value().contents().ending.empty());
    EXPECT_TRUE(outcome.problems.empty());
  }
  EXPECT_GT(refused, 8U);
}

TEST(Recovery, AtEveryByteGivesAWholeFileOfTheSameMessages) {
  const test::TemporaryFolder folder;
  const auto made = made_file(12, Compression::lz4, 60, 400);
  const std::string path = folder / "cut.mcap";
  for (std::size_t size = 40; size < made.bytes.size(); ++size) {
    save(path, Bytes(made.bytes.begin(), made.bytes.begin() + static_cast<std::ptrdiff_t>(size)));
    const auto recovery = record::recover(path);
    ASSERT_TRUE(recovery) << recovery.error().message;
    EXPECT_FALSE(recovery.value().was_whole);
    auto reader = record::Reader::open(path);
    ASSERT_TRUE(reader) << reader.error().message;
    ASSERT_TRUE(reader.value().contents().indexed) << "cut at " << size;
    const auto check = reader.value().check();
    ASSERT_TRUE(check.problems.empty()) << "cut at " << size << ": " << check.problems.front();
    record::Outcome outcome;
    const auto said = test::read_all(reader.value(), outcome);
    ASSERT_EQ(said.size(), messages_within(made.bytes, size));
    ASSERT_EQ(recovery.value().messages, said.size());
    ASSERT_TRUE(std::equal(said.begin(), said.end(), made.said.begin()));
  }
}

TEST(Recovery, LeavesAWholeFileAlone) {
  const test::TemporaryFolder folder;
  const auto made = made_file(13, Compression::zstd);
  save(folder / "whole.mcap", made.bytes);
  const auto recovery = record::recover(folder / "whole.mcap");
  ASSERT_TRUE(recovery);
  EXPECT_TRUE(recovery.value().was_whole);
  EXPECT_EQ(recovery.value().messages, made.said.size());
  auto source = record::FileSource::open(folder / "whole.mcap");
  ASSERT_TRUE(source);
  Bytes after(source.value()->size());
  ASSERT_EQ(source.value()->read(0, after), "");
  EXPECT_EQ(after, made.bytes);
}

TEST(Recovery, KeepsALongRest) {
  const test::TemporaryFolder folder;
  auto bytes = made_file(14, Compression::zstd).bytes;
  auto reader = test::reader_of(bytes);
  const auto& chunk = reader.value().contents().chunks[1];
  bytes[chunk.chunk_start_offset + 5] = 0x70;  // its length: beyond the end of any file
  bytes.pop_back();                            // and it was not closed
  save(folder / "torn.mcap", bytes);
  const auto recovery = record::recover(folder / "torn.mcap", {}, 100);
  ASSERT_TRUE(recovery) << recovery.error().message;
  EXPECT_EQ(recovery.value().cut, bytes.size() - chunk.chunk_start_offset);
  EXPECT_EQ(std::filesystem::file_size(folder / "torn.mcap.rest"), recovery.value().cut);
  EXPECT_NE(recovery.value().ending.find("chunk"), std::string::npos) << recovery.value().ending;
}

TEST(Recovery, RefusesWhatIsNoRecording) {
  const test::TemporaryFolder folder;
  save(folder / "text", {'h', 'e', 'l', 'l', 'o', ' ', 'w', 'o', 'r', 'l', 'd'});
  const auto recovery = record::recover(folder / "text");
  ASSERT_FALSE(recovery);
  EXPECT_NE(recovery.error().message.find("magic"), std::string::npos) << recovery.error().message;
  EXPECT_EQ(std::filesystem::file_size(folder / "text"), 11U);
  EXPECT_FALSE(record::recover(folder / "absent"));
}

TEST(BitFlip, InAnyByteIsNamedAndNeverGivesAWrongMessage) {
  const auto made = made_file(15, Compression::zstd, 30, 300);
  for (std::size_t at = 0; at < made.bytes.size(); ++at) {
    Bytes broken = made.bytes;
    broken[at] ^= static_cast<std::uint8_t>(1U << (at % 8));
    auto reader = test::reader_of(broken);
    if (!reader) continue;  // named by the error
    const auto check = reader.value().check();
    EXPECT_FALSE(check.problems.empty()) << "byte " << at << " of " << made.bytes.size();
    record::Outcome outcome;
    for (const Said& one : test::read_all(reader.value(), outcome)) {
      EXPECT_EQ(one, made.said[one.sequence]) << "byte " << at;
    }
  }
}

TEST(BitFlip, InOneChunkLeavesTheOthersReadable) {
  const auto made = made_file(16, Compression::zstd);
  auto whole = test::reader_of(made.bytes);
  const auto& chunks = whole.value().contents().chunks;
  ASSERT_GT(chunks.size(), 4U);
  Bytes broken = made.bytes;
  broken[chunks[2].chunk_start_offset + chunks[2].chunk_length - 3] ^= 1U;
  auto reader = test::reader_of(broken);
  ASSERT_TRUE(reader);
  record::Outcome outcome;
  const auto said = test::read_all(reader.value(), outcome);
  ASSERT_EQ(outcome.problems.size(), 1U);
  EXPECT_TRUE(outcome.problems[0].starts_with("offset " + std::to_string(chunks[2].chunk_start_offset)));
  EXPECT_LT(said.size(), made.said.size());
  EXPECT_EQ(said.back(), made.said.back());
}

TEST(FileSource, DoesNotWaitForAPipe) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe.mcap").c_str(), 0600), 0);
  const auto source = record::FileSource::open(folder / "pipe.mcap");
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().message.find("pipe.mcap: is no file, expected a recording"), std::string::npos);
}

TEST(Garbage, NeverCrashes) {
  std::mt19937 random(17);
  const auto made = made_file(17, Compression::none, 40, 300);
  for (int i = 0; i < 20'000; ++i) {
    Bytes broken = made.bytes;
    for (std::uint32_t n = 1 + random() % 6; n > 0; --n)
      broken[random() % broken.size()] = static_cast<std::uint8_t>(random());
    if (random() % 4 == 0) broken.resize(random() % broken.size());
    auto reader = test::reader_of(broken, {1U << 20U, 1U << 20U});
    if (!reader) continue;
    EXPECT_LE(reader.value().check().messages, 200U);
  }
}

TEST(Limits, HoldAgainstAChunkThatClaimsToBeLarge) {
  const auto made = made_file(18, Compression::zstd);
  auto reader = test::reader_of(made.bytes, {1U << 20U, 100});
  ASSERT_TRUE(reader);
  record::Outcome outcome;
  test::read_all(reader.value(), outcome);
  ASSERT_FALSE(outcome.problems.empty());
  EXPECT_NE(outcome.problems[0].find("expected at most 100"), std::string::npos) << outcome.problems[0];
}

}  // namespace
}  // namespace fathom
