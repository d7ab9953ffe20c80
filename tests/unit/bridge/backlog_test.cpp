#include "bridge/backlog.hpp"

#include <gtest/gtest.h>

namespace fathom::test {
namespace {

constexpr DurationNs kPeriod = 100 * kNsPerMillisecond;

TEST(Backlog, AsManyAsWereDueArrivedOnePeriodApart) {
  bridge::Backlog backlog(10.0);
  EXPECT_EQ(backlog.spacing(1, 5 * kNsPerSecond), 0);
  EXPECT_EQ(backlog.spacing(2, 5 * kNsPerSecond + 2 * kPeriod), kPeriod);
  EXPECT_EQ(backlog.spacing(3, 5 * kNsPerSecond + 5 * kPeriod), kPeriod);
  EXPECT_EQ(backlog.spacing(20, 90 * kNsPerSecond), kPeriod)
      << "a backlog ends, however long the silence was";
}

TEST(Backlog, NoSampleBeforeTheOneThatWasReadLast) {
  bridge::Backlog backlog(10.0);
  (void)backlog.spacing(1, 0);
  for (const DurationNs since : {kPeriod / 2, kPeriod, 3 * kPeriod / 2, 2 * kPeriod, 7 * kPeriod}) {
    for (std::size_t count = 1; count < 12; ++count) {
      bridge::Backlog one = backlog;
      EXPECT_LT(static_cast<DurationNs>(count - 1) * one.spacing(count, since), since);
    }
  }
}

TEST(Backlog, WhatTheInstrumentSendsTogetherStaysTogether) {
  bridge::Backlog backlog(10.0);
  (void)backlog.spacing(2, 0);
  EXPECT_EQ(backlog.spacing(2, kPeriod), 0);
  EXPECT_EQ(backlog.spacing(2, 2 * kPeriod), 0);
}

TEST(Backlog, TheFirstReadGatheredSinceTheConnectionWasMade) {
  bridge::Backlog backlog(10.0);
  backlog.begin(kNsPerSecond);
  bridge::Backlog at_once = backlog;
  EXPECT_EQ(backlog.spacing(5, kNsPerSecond + 5 * kPeriod), kPeriod);
  EXPECT_EQ(at_once.spacing(5, kNsPerSecond + kPeriod), 0);
}

TEST(Backlog, AnUnknownBeginOrRateTellsNothing) {
  bridge::Backlog first(10.0);
  EXPECT_EQ(first.spacing(5, kNsPerSecond), 0);
  bridge::Backlog unknown(0.0);
  unknown.begin(0);
  (void)unknown.spacing(1, 0);
  EXPECT_EQ(unknown.spacing(2, kNsPerSecond), 0);
}

}  // namespace
}  // namespace fathom::test
