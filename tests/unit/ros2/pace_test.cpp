// How often the gateway says something, and that its time never goes back.

#include "ros2_gateway/pace.hpp"

#include <gtest/gtest.h>

namespace fathom::ros2_gateway {
namespace {

constexpr TimeNs kStart_ns = 1'700'000'000 * kNsPerSecond;

int let_through(double rate_hz, double input_hz, int count) {
  Pace pace(rate_hz);
  int out = 0;
  for (int i = 0; i < count; ++i) {
    out += pace.is_due(kStart_ns + from_seconds(i / input_hz)) ? 1 : 0;
  }
  return out;
}

TEST(Pace, LetsThroughWhatIsAskedFor) {
  EXPECT_EQ(let_through(0.0, 100.0, 1000), 1000) << "all";
  EXPECT_NEAR(let_through(50.0, 100.0, 1000), 500, 2);
  EXPECT_NEAR(let_through(30.0, 100.0, 1000), 300, 3);
  EXPECT_NEAR(let_through(10.0, 400.0, 4000), 100, 2);
  EXPECT_EQ(let_through(100.0, 10.0, 100), 100) << "more than there is";
}

TEST(Pace, DoesNotMakeUpForAGap) {
  Pace pace(10.0);
  EXPECT_TRUE(pace.is_due(kStart_ns));
  EXPECT_TRUE(pace.is_due(kStart_ns + 60 * kNsPerSecond));
  int soon = 0;
  for (int i = 1; i <= 20; ++i) {
    soon += pace.is_due(kStart_ns + 60 * kNsPerSecond + i * 10 * kNsPerMillisecond) ? 1 : 0;
  }
  EXPECT_LE(soon, 3) << "two periods";
}

TEST(OneWay, LeavesOutWhatIsNotLater) {
  OneWay way;
  EXPECT_EQ(way.step(kStart_ns, 0), OneWay::Step::forward);
  EXPECT_EQ(way.step(kStart_ns, 10), OneWay::Step::back);
  EXPECT_EQ(way.step(kStart_ns - 1, 20), OneWay::Step::back);
  EXPECT_EQ(way.step(kStart_ns + 1, 30), OneWay::Step::forward);
}

TEST(OneWay, BeginsAnewWhereTheClockWasSetBack) {
  OneWay way;
  EXPECT_EQ(way.step(kStart_ns, kNsPerSecond), OneWay::Step::forward);
  TimeNs now_ns = kNsPerSecond;
  TimeNs stamp_ns = kStart_ns - 3600 * kNsPerSecond;
  int back = 0;
  OneWay::Step step = OneWay::Step::back;
  for (; back < 1000; ++back) {
    step = way.step(stamp_ns += 10 * kNsPerMillisecond, now_ns += 10 * kNsPerMillisecond);
    if (step != OneWay::Step::back) break;
  }
  EXPECT_EQ(step, OneWay::Step::anew);
  EXPECT_EQ(back, 500) << "after five seconds";
  EXPECT_EQ(way.step(stamp_ns + 1, now_ns), OneWay::Step::forward);
}

TEST(OneWay, ForgetsASingleStepBack) {
  OneWay way;
  EXPECT_EQ(way.step(kStart_ns, kNsPerSecond), OneWay::Step::forward);
  EXPECT_EQ(way.step(kStart_ns - 5, 2 * kNsPerSecond), OneWay::Step::back);
  EXPECT_EQ(way.step(kStart_ns + 5, 3 * kNsPerSecond), OneWay::Step::forward);
  EXPECT_EQ(way.step(kStart_ns, 60 * kNsPerSecond), OneWay::Step::back)
      << "a minute later, and not the second";
}

}  // namespace
}  // namespace fathom::ros2_gateway
