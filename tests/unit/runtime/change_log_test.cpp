#include "runtime/change_log.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace fathom::runtime {
namespace {

TEST(ChangeLog, SaysAFewChangesAtOnceAndOfManyTheNewestOnceAPeriod) {
  ChangeLog log;
  const auto add = [&](double t_s) {
    return log.add({LogLevel::info, "at " + std::to_string(std::lround(t_s))}, from_seconds(t_s));
  };
  int said = 0;
  for (int i = 0; i < 8; ++i) said += add(100.0 + 0.05 * i) ? 1 : 0;
  EXPECT_EQ(said, 8) << "a few are said each";
  EXPECT_FALSE(log.due(from_seconds(111.0)));
  for (double t_s = 200.0; t_s < 255.0; t_s += 0.05) said += add(t_s) ? 1 : 0;
  EXPECT_LE(said, 8 + 8 + 6) << "of twenty a second one in ten seconds";
  EXPECT_FALSE(add(255.0));
  EXPECT_FALSE(log.due(from_seconds(255.0)));
  const auto last = log.due(from_seconds(271.0));
  ASSERT_TRUE(last) << "the state that holds is said in the end";
  EXPECT_EQ(last->text.find("at 255, the last of "), 0U) << last->text;
  EXPECT_FALSE(log.due(from_seconds(290.0)));
}

}  // namespace
}  // namespace fathom::runtime
