// What every codec promises, whatever its protocol: the cut of the stream does not matter, every byte is
// accounted for, the good frames behind garbage are found.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "support/codec/decode_run.hpp"
#include "support/codec/other_contents.hpp"
#include "support/codec/seed_streams.hpp"
#include "support/data.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

class EveryCodec : public testing::TestWithParam<std::string_view> {
 protected:
  std::string_view protocol() const { return GetParam(); }

  void expect_same_however_cut(const ByteVector& bytes, std::uint64_t seed, std::string_view what) {
    const codec::CodecOptions options = seed_options(protocol());
    const DecodeRun whole = decode_whole(protocol(), bytes, options);
    EXPECT_EQ(inconsistency(whole, bytes.size()), "") << what;
    for (const std::size_t largest : {std::size_t{1}, std::size_t{7}, std::size_t{300}}) {
      const DecodeRun cut = decode_chunked(protocol(), bytes, largest, seed, options);
      ASSERT_EQ(whole.transcript, cut.transcript) << what << ", pieces of up to " << largest;
      EXPECT_EQ(whole.totals.frames_ignored, cut.totals.frames_ignored) << what;
      EXPECT_EQ(whole.totals.skipped_bytes, cut.totals.skipped_bytes) << what;
    }
  }
};

std::vector<std::string_view> names() {
  std::vector<std::string_view> found;
  for (const codec::Protocol& protocol : codec::protocols()) found.push_back(protocol.name);
  return found;
}

INSTANTIATE_TEST_SUITE_P(Protocols, EveryCodec, testing::ValuesIn(names()),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(EveryCodec, DecodesItsSeedStreamWithoutLoss) {
  const ByteVector stream = seed_stream(protocol());
  const DecodeRun run = decode_whole(protocol(), stream, seed_options(protocol()));
  EXPECT_GE(run.totals.samples, 8U);
  EXPECT_EQ(run.totals.rejected, 0U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

TEST_P(EveryCodec, TheCutOfTheStreamDoesNotMatter) {
  expect_same_however_cut(seed_stream(protocol()), 1, "seed stream");
}

TEST_P(EveryCodec, NorDoesItInADamagedStream) {
  const ByteVector stream = seed_stream(protocol());
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    expect_same_however_cut(mutated(stream, 1 + seed % 30, seed), seed, "seed " + std::to_string(seed));
  }
}

TEST_P(EveryCodec, NorInNoiseAndInOtherProtocols) {
  expect_same_however_cut(noise(20'000, 7), 7, "noise");
  ByteVector everything;
  for (const std::string_view other : names()) {
    const ByteVector stream = mutated(seed_stream(other), 3, 11);
    everything.insert(everything.end(), stream.begin(), stream.end());
  }
  expect_same_however_cut(everything, 3, "all protocols on one line");
}

TEST_P(EveryCodec, NorWhereADeviceSaysWhatCannotBe) {
  constexpr TimeNs kYear2130_ns = 5'049'129'600 * kNsPerSecond;
  const ByteVector stream = seed_stream(protocol());
  std::size_t samples = 0;
  std::size_t refused = 0;
  std::size_t by_checksum = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const ByteVector other = with_other_contents(protocol(), stream, seed);
    const std::string what = "seed " + std::to_string(seed);
    expect_same_however_cut(other, seed, what);
    const DecodeRun run = decode_whole(protocol(), other, seed_options(protocol()));
    EXPECT_EQ(run.transcript.find("inf"), std::string::npos) << what << ": an infinite number";
    for (const codec::Decoded& each : run.samples) {
      if (!each.time.utc_ns) continue;
      EXPECT_GE(*each.time.utc_ns, 0) << what;
      EXPECT_LT(*each.time.utc_ns, kYear2130_ns) << what;
    }
    samples += run.totals.samples;
    refused += run.totals.rejected;
    by_checksum += static_cast<std::size_t>(std::count_if(
        run.rejected.begin(), run.rejected.end(),
        [](const codec::Rejected& each) { return each.reason == codec::RejectReason::checksum; }));
  }
  EXPECT_GT(samples, 0U);
  EXPECT_GT(refused, 0U);
  // Other contents may say another length, at whose end no checksum stands; they seldom do.
  EXPECT_LT(by_checksum, 1 + refused / 10) << "how its frames are closed belongs in other_contents.cpp";
}

TEST_P(EveryCodec, TheGoodFramesBehindGarbageAreFound) {
  const ByteVector good = seed_stream(protocol());
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    ByteVector stream = noise(100 + 37 * seed, seed);
    // The first copy may suffer from what the noise has begun; the second may not.
    stream.insert(stream.end(), good.begin(), good.end());
    const std::size_t copy = stream.size();
    stream.insert(stream.end(), good.begin(), good.end());
    const DecodeRun run = decode_whole(protocol(), stream, seed_options(protocol()));
    const auto found = std::count_if(run.samples.begin(), run.samples.end(),
                                     [copy](const codec::Decoded& d) { return d.offset >= copy; });
    const DecodeRun clean = decode_whole(protocol(), good, seed_options(protocol()));
    EXPECT_EQ(static_cast<std::size_t>(found), clean.samples.size()) << "seed " << seed;
  }
}

TEST_P(EveryCodec, AllItNeedsForAFrameIsTheFrame) {
  // Fed byte by byte, the first frame's sample must not wait for bytes of a second one.
  const ByteVector good = seed_stream(protocol());
  const DecodeRun all = decode_whole(protocol(), good, seed_options(protocol()));
  ASSERT_FALSE(all.samples.empty());
  const auto codec = codec::find_protocol(protocol())->make(seed_options(protocol()));
  DecodeRun run;
  codec->feed(good, run);
  // Everything but at most the last epoch of a receiver is out before the stream ends.
  EXPECT_GE(run.samples.size() + 1, all.samples.size());
}

/// Folder of recordings that a protocol finds in the shared collection.
std::string_view captures_of(std::string_view protocol) {
  if (protocol == "waterlinked") return "waterlinked_json";
  if (protocol == "paroscientific" || protocol == "ascii_depth") return "pressure";
  if (protocol == "psimssb" || protocol == "psonlld") return "usbl";
  if (protocol == "nortek") return "nortek_dvl";
  if (protocol.ends_with("air_data")) return "air_data";
  return protocol;
}

TEST_P(EveryCodec, NorInRecordingsAndDamagedRecordings) {
  namespace fs = std::filesystem;
  const fs::path own = fs::path(vectors_dir()) / captures_of(protocol());  // in git
  const fs::path folder = fs::is_directory(own) ? own : fs::path(captures_dir()) / captures_of(protocol());
  if (!fs::is_directory(folder)) FATHOM_DATA_IS_MISSING("no recordings in " << folder);
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (entry.is_regular_file() && extension != ".json" && extension != ".chk") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  EXPECT_FALSE(files.empty());
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    ByteVector bytes{std::istreambuf_iterator<char>(in), {}};
    // The beginning of a long recording stands for all of it.
    bytes.resize(std::min<std::size_t>(bytes.size(), 30'000));
    expect_same_however_cut(bytes, 5, file.string());
    expect_same_however_cut(mutated(bytes, 1 + bytes.size() / 500, 5), 6, file.string() + ", damaged");
  }
}

}  // namespace
}  // namespace fathom::test
