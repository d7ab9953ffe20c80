#include "console/view/beacon_book.hpp"

#include <string>

#include <gtest/gtest.h>

#include "unit/console/utc.hpp"

namespace fathom::console {
namespace {

health::Instant instant(double seconds) {
  return {from_seconds(seconds), kUtc + from_seconds(seconds)};
}

RangeSample range_to(const Name& beacon, TimeNs stamp_ns, double range_m = 80.0) {
  RangeSample sample;
  sample.header.sensor = "range";
  sample.header.stamp_ns = stamp_ns;
  sample.beacon = beacon;
  sample.range_m = range_m;
  sample.sigma_m = 0.5;
  sample.beacon_latitude_rad = 0.6;
  sample.beacon_longitude_rad = 2.2;
  sample.beacon_depth_m = 40.0;
  return sample;
}

Verdict verdict_on(TimeNs stamp_ns, VerdictKind kind) {
  Verdict verdict;
  verdict.header.sensor = "range";
  verdict.header.stamp_ns = stamp_ns;
  verdict.source = SourceKind::range;
  verdict.kind = kind;
  return verdict;
}

TEST(BeaconBook, KeepsTheNewestRangeToEachBeacon) {
  BeaconBook book;
  book.add(range_to("1", kUtc, 80.0), instant(0));
  book.add(range_to("2", kUtc + 1, 90.0), instant(1));
  book.add(range_to("1", kUtc + 2, 81.0), instant(2));
  const auto lines = book.lines(instant(3));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].range.range_m, 81.0);
  EXPECT_DOUBLE_EQ(lines[0].age_s, 1.0);
  EXPECT_EQ(lines[1].range.range_m, 90.0);
  EXPECT_DOUBLE_EQ(lines[1].age_s, 2.0);
}

TEST(BeaconBook, ARangeHasItsVerdictWhicheverCameFirst) {
  BeaconBook book;
  book.add(range_to("1", kUtc), instant(0));
  EXPECT_FALSE(book.lines(instant(0))[0].verdict);
  book.judge(verdict_on(kUtc, VerdictKind::rejected));
  EXPECT_EQ(book.lines(instant(0))[0].verdict, VerdictKind::rejected);
  book.judge(verdict_on(kUtc + 5, VerdictKind::used));
  EXPECT_EQ(book.lines(instant(0))[0].verdict, VerdictKind::rejected) << "the verdict is on another range";
  book.add(range_to("1", kUtc + 5), instant(1));
  EXPECT_EQ(book.lines(instant(1))[0].verdict, VerdictKind::used);
}

TEST(BeaconBook, AVerdictOnAnotherSourceChangesNothing) {
  BeaconBook book;
  book.add(range_to("1", kUtc), instant(0));
  Verdict verdict = verdict_on(kUtc, VerdictKind::rejected);
  verdict.source = SourceKind::usbl;
  book.judge(verdict);
  EXPECT_FALSE(book.lines(instant(0))[0].verdict);
}

TEST(BeaconBook, WhatCannotBeDrawnIsLeftOut) {
  BeaconBook book;
  RangeSample nowhere = range_to("1", kUtc);
  nowhere.beacon_latitude_rad = kUnknown;
  book.add(nowhere, instant(0));
  book.add(range_to("2", kUtc, kUnknown), instant(0));
  book.add(range_to("3", kUtc, -1.0), instant(0));
  EXPECT_TRUE(book.lines(instant(0)).empty());
}

TEST(BeaconBook, ForgetsWhatIsOldAndTakesNoMoreThanItHoldsAtOnce) {
  BeaconBook book;
  for (int i = 0; i < 1000; ++i) book.add(range_to(std::string_view(std::to_string(i)), kUtc), instant(0));
  EXPECT_EQ(book.lines(instant(BeaconBook::kForgottenS)).size(), BeaconBook::kMostBeacons);
  EXPECT_TRUE(book.lines(instant(BeaconBook::kForgottenS + 0.1)).empty());
}

}  // namespace
}  // namespace fathom::console
