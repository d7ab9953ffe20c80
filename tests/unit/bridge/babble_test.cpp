// When a line that speaks and is not understood is said to.

#include "bridge/babble.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace fathom::bridge {
namespace {

const std::vector<std::uint8_t> kNoise{0x8e, 0x00, 0xf1, 0x7c, 0x80};

class BabbleTest : public ::testing::Test {
 protected:
  std::optional<Babble::Report> noise(double at_s, std::uint64_t waste = 5) {
    return babble.not_understood(kNoise, waste, from_seconds(at_s));
  }
  Babble babble{5 * kNsPerSecond};
};

TEST_F(BabbleTest, IsSaidOnceItHasLastedAndAgainAtLongIntervals) {
  int said = 0;
  for (int i = 0; i < 100; ++i) {
    const auto report = noise(100.0 + 0.1 * i);
    if (!report) continue;
    ++said;
    EXPECT_EQ(i, 50);
    EXPECT_EQ(report->bytes, 51U * kNoise.size());
    EXPECT_NEAR(report->seconds, 5.0, 1e-6);
    EXPECT_EQ(report->first_bytes, "8e 00 f1 7c 80 8e 00 f1 7c 80 8e 00 f1 7c 80 8e");
  }
  EXPECT_EQ(said, 1);
  for (int i = 110; i < 700; ++i) EXPECT_FALSE(noise(i)) << i;
  const auto again = noise(706.0);
  ASSERT_TRUE(again);
  EXPECT_GT(again->seconds, 590.0);
}

TEST_F(BabbleTest, IsOverWithAGoodFrame) {
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(noise(i));
  EXPECT_FALSE(babble.understood()) << "nothing had been said";
  for (int i = 4; i < 9; ++i) EXPECT_FALSE(noise(i)) << i;
  ASSERT_TRUE(noise(9.5));
  EXPECT_TRUE(babble.understood());
  EXPECT_FALSE(babble.understood());
  EXPECT_FALSE(noise(10.0)) << "half a frame after a cable was out";
  EXPECT_TRUE(noise(16.0)) << "it is said anew";
}

TEST_F(BabbleTest, AFrameThatIsStillComingIsNone) {
  EXPECT_FALSE(noise(0.0)) << "connected in the middle of a frame";
  for (int i = 60; i < 70; ++i) EXPECT_FALSE(noise(i, 0)) << "a long one, of a slow instrument";
}

TEST_F(BabbleTest, ALineThatIsConnectedAgainAndAgainSaysItNoOftener) {
  int said = 0;
  for (int i = 0; i < 600; ++i) {
    if (i % 20 == 0) babble.forget();
    said += noise(i).has_value() ? 1 : 0;
  }
  EXPECT_EQ(said, 1);
}

}  // namespace
}  // namespace fathom::bridge
