#include "samples/innovation_tally.hpp"

#include <random>

#include <gtest/gtest.h>

namespace fathom {
namespace {

Verdict compared(std::mt19937_64& random, VerdictKind kind, double scale, double offset) {
  std::normal_distribution<double> unit;
  Verdict verdict;
  verdict.kind = kind;
  verdict.dimensions = 3;
  for (std::size_t j = 0; j < 3; ++j) {
    verdict.innovation_sigma[j] = 0.5 + static_cast<double>(j);
    verdict.innovation[j] = verdict.innovation_sigma[j] * (offset + scale * unit(random));
  }
  return verdict;
}

TEST(InnovationTally, IsOneWhereSigmasHold) {
  std::mt19937_64 random(2);
  InnovationTally tally;
  for (int i = 0; i < 4000; ++i) {
    tally.add(compared(random, VerdictKind::used, 1.0, 0.0));
    tally.add(compared(random, VerdictKind::late, 50.0, 0.0));  // was not compared
  }
  EXPECT_EQ(tally.measurements(), 4000U);
  EXPECT_EQ(tally.components(), 12'000U);
  EXPECT_NEAR(tally.mean_square(), 1.0, 0.05);
  EXPECT_NEAR(tally.share_within_95(), 0.95, 0.01);
  EXPECT_NEAR(tally.used_rms(), 1.0, 0.03);
}

TEST(InnovationTally, TellsWhatWasUsedFromWhatWasRejected) {
  std::mt19937_64 random(3);
  InnovationTally tally;
  for (int i = 0; i < 2000; ++i) {
    tally.add(compared(random, VerdictKind::used, 1.0, 0.6));
    tally.add(compared(random, VerdictKind::rejected, 1.0, 20.0));
  }
  EXPECT_NEAR(tally.used_mean(0), 0.6, 0.1);
  EXPECT_NEAR(tally.used_rms(), std::sqrt(1.36), 0.05);
  EXPECT_GT(tally.mean_square(), 150.0);
  EXPECT_FALSE(known(tally.used_mean(5)));
}

TEST(InnovationTally, KnowsNothingOfNothing) {
  const InnovationTally tally;
  EXPECT_FALSE(known(tally.mean_square()));
  EXPECT_FALSE(known(tally.share_within_95()));
  EXPECT_FALSE(known(tally.used_rms()));
}

}  // namespace
}  // namespace fathom
