#include "study/runner.hpp"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/random.hpp"

namespace fathom::study {
namespace {

/// Numbers from the seed; `late` has none in about half of the runs.
class Dice final : public Study {
 public:
  [[nodiscard]] std::string_view name() const override { return "dice"; }
  [[nodiscard]] std::string_view description() const override { return "numbers"; }
  [[nodiscard]] std::vector<std::string_view> cases() const override { return {"one", "two"}; }
  [[nodiscard]] std::vector<std::string_view> methods() const override { return {"plain", "twice"}; }
  [[nodiscard]] std::vector<Metric> metrics() const override {
    return {{"value", "m"}, {"late", "s"}, {"figure", "1", Summary::root_mean_square}, {"unused", "1"}};
  }
  [[nodiscard]] int default_runs() const override { return 3; }
  void run(const RunRequest& request, Scores& scores) const override {
    if (request.case_name == "two" && fail) throw std::runtime_error("the die fell off the table");
    sim::Random random(request.seed, "dice");
    const double value = random.normal();
    if (request.wants("plain")) scores.add("plain", "value", value);
    if (!request.wants("twice")) return;
    scores.add("twice", "value", 2.0 * value);
    scores.add("twice", "late", value > 0.0 ? value : std::nan(""));
    scores.add("twice", "figure", value);
  }
  bool fail = false;
};

TEST(Statistics, OfKnownValues) {
  const Statistics s = statistics_of({-4.0, 1.0, 3.0, std::nan(""), 2.0, 0.0});
  EXPECT_EQ(s.n, 5U);
  EXPECT_DOUBLE_EQ(s.mean, 0.4);
  EXPECT_DOUBLE_EQ(s.rms, std::sqrt(6.0));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt((30.0 - 5.0 * 0.16) / 4.0));
  EXPECT_DOUBLE_EQ(s.median, 1.0);
  EXPECT_DOUBLE_EQ(s.p05, -3.2);
  EXPECT_DOUBLE_EQ(s.p95, 2.8);
  EXPECT_DOUBLE_EQ(s.max, 4.0);
  EXPECT_EQ(statistics_of({std::nan("")}).n, 0U);
  EXPECT_TRUE(std::isnan(statistics_of({}).mean));
}

TEST(Runner, SameRowsWithAnyNumberOfThreads) {
  const Dice dice;
  RunOptions options;
  options.runs = 40;
  std::vector<std::vector<Row>> results;
  for (const int threads : {1, 2, 5}) {
    options.threads = threads;
    results.push_back(run_study(dice, options));
  }
  ASSERT_EQ(results[0].size(), 8U);  // two cases of plain value, twice value, late and figure
  for (const auto& rows : results) {
    ASSERT_EQ(rows.size(), results[0].size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_EQ(rows[i].metric, results[0][i].metric);
      EXPECT_EQ(rows[i].statistics.mean, results[0][i].statistics.mean);
      EXPECT_EQ(rows[i].statistics.p95, results[0][i].statistics.p95);
    }
  }
  // The cases of a run share their luck; other runs and other seeds do not.
  EXPECT_EQ(results[0][0].statistics.mean, results[0][4].statistics.mean);
  EXPECT_GT(results[0][0].statistics.std, 0.5);
  options.seed = 2;
  EXPECT_NE(run_study(dice, options)[0].statistics.mean, results[0][0].statistics.mean);
}

TEST(Runner, MissingValuesAndFiguresOfAllRuns) {
  const Dice dice;
  RunOptions options;
  options.runs = 40;
  options.methods = {"twice"};
  options.cases = {"two"};
  const auto rows = run_study(dice, options);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].case_name, "two");
  EXPECT_EQ(rows[1].metric, "late");
  EXPECT_LT(rows[1].statistics.n, 40U);
  EXPECT_GT(rows[1].statistics.n, 5U);
  EXPECT_EQ(rows[2].metric, "figure");
  EXPECT_DOUBLE_EQ(rows[2].statistics.mean, 0.5 * rows[0].statistics.rms);
  EXPECT_EQ(rows[2].statistics.p95, rows[2].statistics.mean);
  EXPECT_EQ(rows[2].statistics.std, 0.0);
}

TEST(Runner, SaysWhatIsWrong) {
  Dice dice;
  RunOptions options;
  options.cases = {"three"};
  try {
    (void)run_study(dice, options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("case: three: expected one of one two"));
  }
  dice.fail = true;
  options.cases.clear();
  options.runs = 10;
  options.threads = 3;
  EXPECT_THROW((void)run_study(dice, options), std::runtime_error);
}

}  // namespace
}  // namespace fathom::study
