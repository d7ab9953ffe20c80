#include "cli/solve/compare/verdict_changes.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace fathom::cli {
namespace {

Verdict verdict(const char* sensor, double t_s, std::uint64_t sequence, VerdictKind kind) {
  Verdict out;
  out.header.sensor = Name(sensor);
  out.header.stamp_ns = from_seconds(t_s);
  out.header.sequence = sequence;
  out.source = SourceKind::gps;
  out.model = Name("gps_position");
  out.kind = kind;
  out.is_final = true;
  return out;
}

TEST(VerdictChanges, EqualRunsHaveNone) {
  VerdictChanges changes(0);
  for (std::uint64_t i = 0; i < 50; ++i)
    for (std::size_t run = 0; run < 2; ++run)
      changes.add(run, verdict("gps0", static_cast<double>(i), i, VerdictKind::used));
  changes.finish();
  EXPECT_TRUE(changes.changes().empty());
  EXPECT_TRUE(changes.runs().empty());
  EXPECT_EQ(changes.measurements(), 50U);
}

TEST(VerdictChanges, FindsExactlyWhatDiffersInWhateverOrderItComes) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::pair<std::size_t, Verdict>> all;
    std::size_t expected = 0;
    for (std::uint64_t i = 0; i < 40; ++i) {
      const auto pick = random() % 4;
      const auto first = pick == 1 ? VerdictKind::rejected : VerdictKind::used;
      const auto second = pick == 2 ? VerdictKind::late : first;
      all.emplace_back(0, verdict("gps0", static_cast<double>(i), i, first));
      if (pick != 3) all.emplace_back(1, verdict("gps0", static_cast<double>(i), i, second));
      expected += pick >= 2 ? 1U : 0U;
    }
    std::shuffle(all.begin(), all.end(), random);
    VerdictChanges changes(0);
    for (const auto& [run, one] : all) changes.add(run, one);
    changes.finish();
    ASSERT_EQ(changes.changes().size(), expected);
    ASSERT_EQ(changes.measurements(), 40U);
    ASSERT_TRUE(std::is_sorted(changes.changes().begin(), changes.changes().end(),
                               [](const auto& a, const auto& b) { return a.t_s < b.t_s; }));
    std::uint64_t in_runs = 0;
    for (const auto& run : changes.runs()) in_runs += run.count;
    ASSERT_EQ(in_runs, expected);
  }
}

TEST(VerdictChanges, PutsWhatFollowsEachOtherTogether) {
  VerdictChanges changes(0);
  const auto both = [&](const char* sensor, std::uint64_t i, VerdictKind first, VerdictKind second) {
    changes.add(0, verdict(sensor, static_cast<double>(i), i, first));
    changes.add(1, verdict(sensor, static_cast<double>(i), i, second));
  };
  for (std::uint64_t i = 0; i < 10; ++i) {
    // One that stays as it was parts the third to the fifth from the seventh; another sensor parts nothing.
    const bool differs = i >= 3 && i <= 7 && i != 6;
    both("gps0", i, VerdictKind::used, differs ? VerdictKind::rejected : VerdictKind::used);
    both("gps1", i, VerdictKind::used, i == 4 ? VerdictKind::late : VerdictKind::used);
  }
  changes.finish();
  const auto runs = changes.runs();
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0].sensor, "gps0");
  EXPECT_EQ(runs[0].begin_s, 3.0);
  EXPECT_EQ(runs[0].end_s, 5.0);
  EXPECT_EQ(runs[0].count, 3U);
  EXPECT_EQ(runs[1].sensor, "gps1");
  EXPECT_EQ(runs[1].second, VerdictKind::late);
  EXPECT_EQ(runs[2].begin_s, 7.0);
  EXPECT_EQ(runs[2].count, 1U);
}

TEST(VerdictChanges, PairsRepeatsInTheirOrder) {
  VerdictChanges changes(0);
  changes.add(0, verdict("gps0", 1.0, 5, VerdictKind::used));
  changes.add(0, verdict("gps0", 1.0, 5, VerdictKind::duplicate));
  changes.add(1, verdict("gps0", 1.0, 5, VerdictKind::used));
  changes.finish();
  ASSERT_EQ(changes.changes().size(), 1U);
  EXPECT_EQ(changes.changes()[0].first, VerdictKind::duplicate);
  EXPECT_EQ(changes.changes()[0].second, std::nullopt);
  EXPECT_EQ(report::word_of(changes.changes()[0].second), "not judged");
}

}  // namespace
}  // namespace fathom::cli
