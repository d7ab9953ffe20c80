#include "status/book.hpp"

#include <gtest/gtest.h>

namespace fathom::status {
namespace {

TEST(StatusBook, TellsSinceWhenAReceiverIsRefused) {
  StatusBook book("auv");
  const auto judge = [&](double t, VerdictKind kind) {
    Verdict verdict;
    verdict.header.vehicle = "auv";
    verdict.header.sensor = "gps";
    verdict.kind = verdict.previous = kind;
    book.add(verdict, from_seconds(t));
  };
  const auto counts = [&](double t) { return book.view(from_seconds(t)).verdicts.at("gps"); };
  judge(100.0, VerdictKind::used);
  EXPECT_EQ(counts(100.5).refused_for_s, 0.0);
  judge(101.0, VerdictKind::rejected);
  judge(102.0, VerdictKind::disputed);
  EXPECT_EQ(counts(103.0).refused_for_s, 2.0);
  EXPECT_EQ(counts(103.0).last_age_s, 1.0);
  EXPECT_EQ(counts(103.0).last, VerdictKind::disputed);
  judge(104.0, VerdictKind::no_fix);
  EXPECT_EQ(counts(105.0).refused_for_s, 0.0);
  EXPECT_EQ(counts(105.0).last, VerdictKind::no_fix);
  judge(106.0, VerdictKind::late);
  EXPECT_EQ(counts(107.0).refused_for_s, 1.0);
}

}  // namespace
}  // namespace fathom::status
