#include "live/record/ledger.hpp"

#include <gtest/gtest.h>

#include "samples/nav_state.hpp"

namespace fathom::cli {
namespace {

using States = Ledger<TimeNs, NavState>;

NavState state(TimeNs stamp_ns, double latitude_rad) {
  NavState out;
  out.header.stamp_ns = stamp_ns;
  out.latitude_rad = latitude_rad;
  return out;
}

TEST(Ledger, WhicheverComesFirst) {
  States ledger(10);
  EXPECT_FALSE(ledger.computed(1, state(1, 0.5)).equal);
  EXPECT_TRUE(ledger.recorded(1, state(1, 0.5), 0).equal);
  EXPECT_FALSE(ledger.recorded(2, state(2, 0.5), 1).equal);
  EXPECT_TRUE(ledger.computed(2, state(2, 0.5)).equal);
}

TEST(Ledger, TheDifferenceIsInWords) {
  States ledger(10);
  (void)ledger.computed(1, state(1, 0.5));
  const States::Match match = ledger.recorded(1, state(1, 0.25), 0);
  EXPECT_FALSE(match.equal);
  EXPECT_NE(match.difference.find("latitude"), std::string::npos) << match.difference;
}

TEST(Ledger, WhatWasComputedBeforeAnyNumberOfTakeoversCounts) {
  States ledger(10);
  (void)ledger.computed(1, state(1, 0.1));
  ledger.renew();
  (void)ledger.computed(2, state(2, 0.2));
  ledger.renew();
  (void)ledger.computed(2, state(2, 0.3));
  ledger.renew();
  EXPECT_TRUE(ledger.recorded(1, state(1, 0.1), 0).equal);
  EXPECT_TRUE(ledger.recorded(2, state(2, 0.2), 1).equal);
  EXPECT_TRUE(ledger.recorded(2, state(2, 0.3), 2).equal);
  EXPECT_FALSE(ledger.recorded(2, state(2, 0.2), 3).equal) << "said once, counts once";
}

TEST(Ledger, MemoryIsBoundedOverTakeovers) {
  States ledger(10);
  for (TimeNs stamp = 0; stamp < 1000; ++stamp) {
    (void)ledger.computed(stamp, state(stamp, 0.1));
    ledger.renew();
  }
  EXPECT_FALSE(ledger.recorded(989, state(989, 0.1), 0).equal);
  EXPECT_TRUE(ledger.recorded(990, state(990, 0.1), 1).equal);
  EXPECT_TRUE(ledger.recorded(999, state(999, 0.1), 2).equal);
}

TEST(Ledger, WhatFollowsFromNothingIsNamed) {
  States ledger(10);
  (void)ledger.recorded(7, state(7, 0.5), 3);
  const auto found = ledger.unfounded([](const NavState&, std::size_t when) { return when < 5; });
  ASSERT_TRUE(found);
  EXPECT_EQ(found->header.stamp_ns, 7);
  EXPECT_FALSE(ledger.unfounded([](const NavState&, std::size_t when) { return when < 3; }));
}

}  // namespace
}  // namespace fathom::cli
