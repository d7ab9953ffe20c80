#include "codec/framer.hpp"

#include <set>
#include <string_view>

#include <gtest/gtest.h>

#include "support/codec/decode_run.hpp"

namespace fathom::codec {
namespace {

/// `<` length-digit payload `>`: small enough to reason about. Payload "s" is a sample, "r" is refused.
class Toy final : public Framer {
 public:
  explicit Toy(bool lines = false) : Framer(12, lines ? LineEnds::belong_to_frames : LineEnds::are_bytes) {}

  static constexpr std::size_t kNever = 99;

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override {
    if (front[0] != '<') return Probe::skip(1);
    if (front.size() < 2) return Probe::maybe();
    if (front[1] == '?') return Probe::need();
    if (front[1] == '!') return Probe::need(kNever);
    const std::size_t total = static_cast<std::size_t>(front[1] - '0') + 3;
    if (front.size() < total) return Probe::need(total);
    return front[total - 1] == '>' ? Probe::frame(total) : Probe::bad(RejectReason::checksum, total);
  }
  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    if (frame[2] == 'r') return Outcome::refused(RejectReason::field);
    if (frame[2] != 's') return Outcome::ignored();
    emit(sink, DepthSample{}, {}, offset, frame.size());
    return Outcome::used();
  }
};

struct Seen {
  test::DecodeRun run;
  Totals totals;
};

Seen see(std::string_view text, Toy toy = Toy()) {
  Seen seen;
  toy.feed(test::bytes_of(text), seen.run);
  toy.finish(seen.run);
  seen.run.totals = seen.totals = toy.totals();
  return seen;
}

TEST(Framer, EveryByteIsInAGoodFrameRefusedOrSkipped) {
  const Seen seen = see("ab<1s>c<1x>dd");
  EXPECT_EQ(seen.totals.bytes, 13U);
  EXPECT_EQ(seen.totals.samples, 1U);
  EXPECT_EQ(seen.totals.frames_ignored, 1U);
  EXPECT_EQ(seen.totals.rejected, 0U);
  EXPECT_EQ(seen.totals.skipped_bytes, 5U);
  ASSERT_EQ(seen.run.samples.size(), 1U);
  EXPECT_EQ(seen.run.samples[0].offset, 2U);
  EXPECT_EQ(seen.run.samples[0].length, 4U);
}

TEST(Framer, FindsAGoodFrameInsideARefusedOne) {
  const Seen seen = see("<6a<1s>bb<1s>");
  ASSERT_EQ(seen.run.rejected.size(), 1U);
  EXPECT_EQ(seen.run.rejected[0].reason, RejectReason::checksum);
  EXPECT_EQ(seen.run.rejected[0].offset, 0U);
  EXPECT_EQ(seen.run.rejected[0].length, 9U);
  ASSERT_EQ(seen.run.samples.size(), 2U);
  EXPECT_EQ(seen.run.samples[0].offset, 3U);
  EXPECT_EQ(seen.run.samples[1].offset, 9U);
  EXPECT_EQ(seen.totals.skipped_bytes, 0U);
}

TEST(Framer, DamageInsideARefusedFrameIsReportedOnce) {
  const Seen seen = see("<5<1x!<1x!..");
  ASSERT_EQ(seen.run.rejected.size(), 1U);
  EXPECT_EQ(seen.run.rejected[0].length, 8U);
  EXPECT_EQ(seen.totals.skipped_bytes, 4U);
}

TEST(Framer, TheEndCutsAFrameButAMereBeginningIsSkipped) {
  const Seen cut = see("<1s><5ab");
  ASSERT_EQ(cut.run.rejected.size(), 1U);
  EXPECT_EQ(cut.run.rejected[0].reason, RejectReason::truncated);
  EXPECT_EQ(cut.run.rejected[0].offset, 4U);
  EXPECT_EQ(cut.run.rejected[0].length, 4U);
  const Seen begun = see("<1s><");
  EXPECT_TRUE(begun.run.rejected.empty());
  EXPECT_EQ(begun.totals.skipped_bytes, 1U);
}

TEST(Framer, AGoodFrameInsideTheCutOneStillComesAtTheEnd) {
  const Seen seen = see("<9<1s>");
  ASSERT_EQ(seen.run.samples.size(), 1U);
  EXPECT_EQ(seen.run.samples[0].offset, 2U);
}

TEST(Framer, AFrameThatNeverEndsIsRefusedAtTheLimit) {
  const Seen seen = see("<?<1s>..............");
  ASSERT_EQ(seen.run.rejected.size(), 1U);
  EXPECT_EQ(seen.run.rejected[0].reason, RejectReason::length);
  EXPECT_EQ(seen.run.rejected[0].length, 12U);
  ASSERT_EQ(seen.run.samples.size(), 1U);
}

TEST(Framer, AFrameThatWantsTooMuchIsRefusedAtOnceWhateverHasArrived) {
  for (const std::string_view text : {"<!", "<!<1s>........................."}) {
    Toy toy;
    test::DecodeRun run;
    toy.feed(test::bytes_of(text), run);
    ASSERT_EQ(run.rejected.size(), 1U) << text;
    EXPECT_EQ(run.rejected[0].length, 1U);
  }
}

TEST(Framer, ARefusalByDecodeIsAReject) {
  const Seen seen = see("<1r><1s>");
  ASSERT_EQ(seen.run.rejected.size(), 1U);
  EXPECT_EQ(seen.run.rejected[0].reason, RejectReason::field);
  EXPECT_EQ(seen.run.samples.size(), 1U);
}

TEST(Framer, LineEndsCountToTheFrameBeforeThem) {
  const Seen seen = see("\r\n<1s>\r\n<1x)\r\n\r\n.\r\n", Toy(true));
  EXPECT_EQ(seen.totals.rejected, 1U);
  // The first and the last line end follow no frame.
  EXPECT_EQ(seen.totals.skipped_bytes, 2U + 3U);
}

class Toy2 : public Framer {
 public:
  Toy2() : Framer(8, LineEnds::belong_to_frames) {}

 protected:
  [[nodiscard]] Probe probe(Bytes /*front*/) const override { return Probe::skip(1); }
  Outcome decode(Bytes, std::uint64_t, Sink&) override { return Outcome::ignored(); }
};

TEST(Framer, LineEndsAtTheVeryBeginningFollowNothing) {
  Toy2 framer;
  test::DecodeRun run;
  framer.feed(test::bytes_of("\r\n\r\n"), run);
  EXPECT_EQ(framer.totals().skipped_bytes, 4U);
}

TEST(Framer, OffsetsRunOnPastTheBuffer) {
  Toy toy;
  test::DecodeRun run;
  const test::ByteVector noise(100'000, '.');
  toy.feed(noise, run);
  toy.feed(test::bytes_of("<1s>"), run);
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(run.samples[0].offset, 100'000U);
  EXPECT_EQ(toy.totals().skipped_bytes, 100'000U);
}

TEST(RejectReason, EveryReasonHasItsOwnWord) {
  std::set<std::string_view> words;
  for (int i = 0; i <= static_cast<int>(RejectReason::truncated); ++i) {
    words.insert(to_string(static_cast<RejectReason>(i)));
  }
  EXPECT_EQ(words.size(), 7U);
  EXPECT_FALSE(words.contains("unknown"));
}

}  // namespace
}  // namespace fathom::codec
