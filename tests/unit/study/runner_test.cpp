#include "study/runner.hpp"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/random.hpp"

namespace fathom::study {
namespace {

/// Numbers from the seed; `late` has none in about half of the runs, `lost` loses its value in as many.
class Dice final : public Study {
 public:
  [[nodiscard]] std::string_view name() const override { return "dice"; }
  [[nodiscard]] std::string_view description() const override { return "numbers"; }
  [[nodiscard]] std::vector<std::string_view> cases() const override { return {"one", "two"}; }
  [[nodiscard]] std::vector<std::string_view> methods() const override {
    return {"plain", "twice", "lost", "silent"};
  }
  [[nodiscard]] std::vector<Metric> metrics() const override {
    return {{"value", "m"},
            {"late", "s", Summary::distribution, Presence::if_it_happens},
            {"figure", "1", Summary::root_mean_square},
            {"unused", "1"}};
  }
  [[nodiscard]] int default_runs() const override { return 3; }
  void run(const RunRequest& request, Scores& scores) const override {
    if (request.case_name == "two" && fail) throw std::runtime_error("the die fell off the table");
    sim::Random random(request.seed, "dice");
    const double value = random.normal();
    if (request.wants("plain")) scores.add("plain", "value", value);
    if (request.wants("lost")) scores.add("lost", "value", value > 0.0 ? value : std::nan(""));
    if (request.wants("silent") && value > 0.0) scores.add("silent", "value", value);
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
  // Two cases of the values of plain, lost and silent, of value, late and figure of twice, and of what
  // failed.
  ASSERT_EQ(results[0].size(), 20U);
  for (const auto& rows : results) {
    ASSERT_EQ(rows.size(), results[0].size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_EQ(rows[i].metric, results[0][i].metric);
      EXPECT_EQ(rows[i].statistics.mean, results[0][i].statistics.mean);
      EXPECT_EQ(rows[i].statistics.p95, results[0][i].statistics.p95);
    }
  }
  // The cases of a run share their luck; other runs and other seeds do not.
  EXPECT_EQ(results[0][0].statistics.mean, results[0][10].statistics.mean);
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
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].case_name, "two");
  EXPECT_EQ(rows[1].metric, "late");
  EXPECT_LT(rows[1].statistics.n, 40U);
  EXPECT_GT(rows[1].statistics.n, 5U);
  EXPECT_EQ(rows[1].statistics.n + rows[1].missing, 40U);
  EXPECT_EQ(rows[2].metric, "figure");
  EXPECT_DOUBLE_EQ(rows[2].statistics.mean, 0.5 * rows[0].statistics.rms);
  EXPECT_EQ(rows[2].statistics.p95, rows[2].statistics.mean);
  EXPECT_EQ(rows[2].statistics.std, 0.0);
  EXPECT_EQ(rows[3].metric, kFailedMetric);
  EXPECT_EQ(rows[3].statistics.mean, 0.0);  // `late` need not happen
}

TEST(Runner, RunsWithoutAResultAreCounted) {
  const Dice dice;
  RunOptions options;
  options.runs = 40;
  options.cases = {"one"};
  for (const char* method : {"lost", "silent"}) {
    options.methods = {method};
    const auto rows = run_study(dice, options);
    ASSERT_EQ(rows.size(), 2U) << method;
    EXPECT_EQ(rows[1].metric, kFailedMetric) << method;
    EXPECT_EQ(rows[1].statistics.n, 40U) << method;
    const double without = 40.0 - static_cast<double>(rows[0].statistics.n);
    EXPECT_GT(without, 5.0) << method;
    EXPECT_DOUBLE_EQ(rows[1].statistics.mean, without / 40.0) << method;
  }
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
