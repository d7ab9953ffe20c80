// A reader rests after a take that took long to find nothing, and not otherwise.

#include "bus/detail/workarounds/take_pace.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace fathom::bus::detail {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

class Pace : public testing::Test {
 protected:
  milliseconds took(microseconds long_to_find_nothing) {
    const TakePace::Time began = now;
    now += long_to_find_nothing;
    return pace.found_nothing(began, now);
  }

  TakePace::Time now{std::chrono::hours(1)};
  TakePace pace;
};

TEST_F(Pace, NobodyRestsWhereNothingWaits) {
  EXPECT_FALSE(pace.rests(now));
  EXPECT_EQ(took(microseconds(1)), milliseconds(0));
  EXPECT_EQ(took(microseconds(199)), milliseconds(0));
  EXPECT_FALSE(pace.rests(now));
}

TEST_F(Pace, TheRestIsFiveTimesAsLongAsTheTakeWas) {
  const milliseconds rest = took(microseconds(2000));
  EXPECT_EQ(rest, milliseconds(10));
  EXPECT_TRUE(pace.rests(now));
  EXPECT_TRUE(pace.rests(now + rest - microseconds(1)));
  EXPECT_FALSE(pace.rests(now + rest));
}

TEST_F(Pace, AThreadThatWasKeptFromRunningRestsNoLongerThanOthersBear) {
  EXPECT_EQ(took(std::chrono::minutes(1)), milliseconds(50));
  now += milliseconds(50);
  EXPECT_FALSE(pace.rests(now));
  EXPECT_EQ(took(microseconds(10)), milliseconds(0));
}

}  // namespace
}  // namespace fathom::bus::detail
