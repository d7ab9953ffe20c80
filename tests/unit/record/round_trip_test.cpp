// What was written is read again: random files, every compression, with and without the index.

#include <algorithm>
#include <span>
#include <utility>

#include <gtest/gtest.h>

#include "made_file.hpp"
#include "record/wire.hpp"

namespace fathom {
namespace {

using record::Bytes;
using record::Compression;
using test::made_file;
using test::Said;

class RoundTrip : public testing::TestWithParam<Compression> {};

TEST_P(RoundTrip, KeepsEveryMessageInTheOrderOfWriting) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    const auto made = made_file(seed, GetParam());
    auto reader = test::reader_of(made.bytes);
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_TRUE(reader.value().contents().indexed);
    record::Outcome outcome;
    EXPECT_EQ(test::read_all(reader.value(), outcome), made.said) << "seed " << seed;
    EXPECT_TRUE(outcome.problems.empty());
    const auto check = reader.value().check();
    EXPECT_TRUE(check.problems.empty()) << check.problems.front();
    EXPECT_EQ(check.messages, made.said.size());
  }
}

/// Counts what is read of a file.
class CountingSource final : public record::Source {
 public:
  CountingSource(const Bytes& bytes, std::uint64_t& count) : inner_(bytes), count_(count) {}
  [[nodiscard]] std::uint64_t size() const override { return inner_.size(); }
  [[nodiscard]] std::string read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    count_ += out.size();
    return inner_.read(offset, out);
  }

 private:
  record::MemorySource inner_;
  std::uint64_t& count_;
};

TEST_P(RoundTrip, GroupsOfChannelsComeTogetherByTime) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    const auto made = made_file(seed, GetParam(), 200, 2000, true);
    auto reader = test::reader_of(made.bytes);
    ASSERT_TRUE(reader) << reader.error().message;
    record::Outcome outcome;
    EXPECT_EQ(test::read_all(reader.value(), outcome), made.said) << "seed " << seed;
    const auto check = reader.value().check();
    EXPECT_TRUE(check.problems.empty()) << check.problems.front();
    Bytes cut = made.bytes;
    cut.pop_back();
    auto unfinished = test::reader_of(cut);
    ASSERT_TRUE(unfinished);
    EXPECT_EQ(test::read_all(unfinished.value(), outcome), made.said) << "seed " << seed;
  }
}

TEST_P(RoundTrip, WhoReadsOneGroupDoesNotReadTheOthers) {
  const auto made = made_file(5, GetParam(), 2000, 20'000, true);
  std::uint64_t count = 0;
  auto reader = record::Reader::open(std::make_unique<CountingSource>(made.bytes, count));
  ASSERT_TRUE(reader);
  record::Outcome outcome;
  count = 0;
  const auto some = test::read_all(reader.value(), outcome, {{"c"}});
  const std::uint64_t of_one = std::exchange(count, 0);
  const auto all = test::read_all(reader.value(), outcome);
  EXPECT_EQ(all, made.said);
  EXPECT_EQ(static_cast<std::size_t>(
                std::count_if(all.begin(), all.end(), [](const Said& one) { return one.topic == "c"; })),
            some.size());
  EXPECT_LT(of_one, count / 2);
}

TEST_P(RoundTrip, GivesTheSameWithoutTheSummary) {
  const auto made = made_file(7, GetParam());
  Bytes cut = made.bytes;
  cut.pop_back();
  auto whole = test::reader_of(made.bytes);
  auto reader = test::reader_of(cut);
  ASSERT_TRUE(whole && reader);
  EXPECT_FALSE(reader.value().contents().indexed);
  EXPECT_FALSE(reader.value().contents().ending.empty());
  record::Outcome outcome;
  EXPECT_EQ(test::read_all(reader.value(), outcome), made.said);
  const auto& a = whole.value().contents();
  const auto& b = reader.value().contents();
  EXPECT_EQ(a.schemas, b.schemas);
  EXPECT_EQ(a.channels, b.channels);
  ASSERT_EQ(a.chunks.size(), b.chunks.size());
  for (std::size_t i = 0; i < a.chunks.size(); ++i) {
    EXPECT_EQ(a.chunks[i].message_index_offsets, b.chunks[i].message_index_offsets);
    EXPECT_EQ(a.chunks[i].message_index_length, b.chunks[i].message_index_length);
  }
  EXPECT_EQ(a.statistics.channel_message_counts, b.statistics.channel_message_counts);
  EXPECT_EQ(a.statistics.message_start_time, b.statistics.message_start_time);
  EXPECT_EQ(a.statistics.message_end_time, b.statistics.message_end_time);
}

TEST_P(RoundTrip, SelectsByTopicAndTime) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto made = made_file(seed, GetParam());
    auto reader = test::reader_of(made.bytes);
    ASSERT_TRUE(reader);
    const TimeNs from = 1'000 + 100 * seed;
    const TimeNs to = from + 400;
    std::vector<Said> expected;
    std::copy_if(made.said.begin(), made.said.end(), std::back_inserter(expected), [&](const Said& one) {
      return (one.topic == "b" || one.topic == "c") && one.log_time >= from && one.log_time < to;
    });
    record::Outcome outcome;
    EXPECT_EQ(test::read_all(reader.value(), outcome, {{"b", "c"}, from, to}), expected);
    EXPECT_EQ(outcome.messages, expected.size());
  }
}

TEST_P(RoundTrip, KeepsAttachmentMetadataAndDescriptions) {
  const auto made = made_file(3, GetParam());
  auto reader = test::reader_of(made.bytes);
  ASSERT_TRUE(reader);
  const auto attachment = reader.value().attachment("config.json");
  ASSERT_TRUE(attachment);
  EXPECT_EQ(attachment.value(), made.attachment);
  EXPECT_FALSE(reader.value().attachment("other"));
  const auto& contents = reader.value().contents();
  ASSERT_EQ(contents.metadata.size(), 1U);
  const auto metadata = reader.value().metadata(contents.metadata[0]);
  ASSERT_TRUE(metadata);
  EXPECT_EQ(metadata.value().metadata, made.metadata);
  EXPECT_EQ(contents.channels.size(), 3U) << "a channel without messages is not written";
  EXPECT_EQ(contents.channels.begin()->second.metadata, (record::TextMap{{"key", "value"}}));
  EXPECT_EQ(contents.header.library, "test");
  const auto* schema = reader.value().schema_of(contents.channels.begin()->second);
  ASSERT_NE(schema, nullptr);
  EXPECT_EQ(schema->name, "fathom::v1::A");
}

INSTANTIATE_TEST_SUITE_P(Compressions, RoundTrip,
                         testing::Values(Compression::none, Compression::lz4, Compression::zstd));

TEST(Reader, StopsWhenTheHandlerHasEnough) {
  const auto made = made_file(1, Compression::zstd);
  auto reader = test::reader_of(made.bytes);
  ASSERT_TRUE(reader);
  int count = 0;
  const auto outcome = reader.value().read({}, [&](const auto&, const auto&) { return ++count < 17; });
  EXPECT_EQ(count, 17);
  EXPECT_EQ(outcome.messages, 17U);
}

TEST(Reader, ReadsMessagesOutsideOfChunks) {
  Bytes bytes(record::kMagic.begin(), record::kMagic.end());
  record::append(bytes, record::Header{"", "other"});
  record::append(bytes, record::Channel{4, 0, "x", "json", {}});
  const Bytes data{'{', '}'};
  record::append(bytes, record::Message{4, 9, 100, 90, data});
  bytes.push_back(0xF0);  // a record of somebody's own, which ends too soon
  auto reader = test::reader_of(bytes);
  ASSERT_TRUE(reader) << reader.error().message;
  record::Outcome outcome;
  const auto said = test::read_all(reader.value(), outcome);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0], (Said{"x", 9, 100, 90, data}));
  EXPECT_NE(reader.value().contents().ending.find("only 1 are there"), std::string::npos);
}

TEST(Writer, AFailedAppendLosesItsChunkAndNothingElse) {
  // Of three chunks the second one finds no room on the disk.
  struct Failing final : record::Sink {
    explicit Failing(Bytes& bytes) : memory(bytes) {}
    std::string append(record::View bytes) override {
      return full ? "No space left on device" : memory.append(bytes);
    }
    std::string sync() override { return {}; }
    std::uint64_t size() const override { return memory.size(); }
    record::MemorySink memory;
    bool full = false;
  };
  Bytes bytes;
  auto sink = std::make_unique<Failing>(bytes);
  Failing& disk = *sink;
  record::Writer writer(std::move(sink), {});
  ASSERT_EQ(writer.begin(), "");
  const auto a = writer.add_channel(writer.add_schema("A", "omgidl", "x"), "a", "cdr");
  const auto b = writer.add_channel(writer.add_schema("B", "omgidl", "y"), "b", "cdr");
  ASSERT_EQ(writer.write({a, 1, 10, 10, {}}), "");
  ASSERT_EQ(writer.flush(), "");
  disk.full = true;
  ASSERT_EQ(writer.write({a, 2, 20, 20, {}}), "");
  ASSERT_EQ(writer.write({b, 3, 21, 21, {}}), "");
  EXPECT_EQ(writer.flush(), "No space left on device");
  auto lost = writer.take_lost();
  EXPECT_EQ(lost.size(), 2U);
  EXPECT_EQ(lost[a].count, 1U);
  EXPECT_EQ(lost[b].last_time, 21);
  EXPECT_TRUE(writer.take_lost().empty());
  disk.full = false;
  ASSERT_EQ(writer.write({b, 4, 30, 30, {}}), "");
  ASSERT_EQ(writer.finish(), "");
  auto reader = test::reader_of(bytes);
  ASSERT_TRUE(reader);
  EXPECT_TRUE(reader.value().check().problems.empty());
  record::Outcome outcome;
  const auto said = test::read_all(reader.value(), outcome);
  ASSERT_EQ(said.size(), 2U);
  EXPECT_EQ(said[0].sequence, 1U);
  EXPECT_EQ(said[1].sequence, 4U);
  EXPECT_EQ(said[1].topic, "b");
}

}  // namespace
}  // namespace fathom
