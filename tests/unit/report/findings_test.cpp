#include <cmath>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/material.hpp"

namespace fathom::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A run in which nothing is wrong: innovations of unit variance, unless they are spread by a factor or the
// second component is off by some sigmas.
Material quiet(double factor = 1.0, double offset = 0.0) {
  Material m;
  m.title = "quiet";
  m.begin_s = 0.0;
  m.end_s = 200.0;
  m.imu_samples = 20'000;
  m.phases = {{0.0, AlignmentPhase::coarse}, {20.0, AlignmentPhase::aligned}};
  for (int i = 0; i < 200; ++i) {
    StateRow row;
    row.t_s = i;
    row.latitude_rad = 0.8 + 1e-6 * i;
    row.longitude_rad = 0.2;
    row.covariance_NE_m2 = {1.0, 0.2, 0.2, 2.0};
    row.position_sigma_N_m = {1.0, 1.4, 2.0};
    row.mode = NavMode::gps_aided;
    m.states.push_back(row);
  }
  Source gps;
  gps.sensor = "gps";
  gps.model = "gps_position";
  std::mt19937_64 random(2);
  std::normal_distribution<double> unit;
  for (int i = 0; i < 400; ++i) {
    Verdict v;
    v.dimensions = 3;
    for (std::size_t k = 0; k < 3; ++k) {
      v.innovation_sigma[k] = 2.0;
      v.innovation[k] = 2.0 * (factor * unit(random) + (k == 1 ? offset : 0.0));
    }
    gps.add(v, 0.5 * i);
  }
  m.sources.push_back(gps);
  m.samples["gps"] = 400;
  return m;
}

std::string all(const Material& m) {
  std::string text;
  for (const Finding& one : findings(m)) text += one.text + "\n";
  return text;
}

TEST(Findings, NothingIsSaidOfAQuietRun) {
  const auto found = findings(quiet());
  ASSERT_EQ(found.size(), 1U) << all(quiet());
  EXPECT_EQ(found[0].weight, Finding::Weight::good);
}

TEST(Findings, RejectionsAreNamedWithTheirTime) {
  Material m = quiet();
  for (int i = 0; i < 60; ++i) {
    Verdict v;
    v.kind = VerdictKind::rejected;
    m.sources[0].add(v, 120.0 + 0.1 * i);
  }
  EXPECT_THAT(
      all(m),
      HasSubstr("gps (gps_position): 13 % of 460 measurements were rejected, most of them around 120 s"));
}

TEST(Findings, ABiasAWideAndANarrowSpreadAreTold) {
  for (const auto& [offset, factor, words] :
       {std::tuple{1.0, 1.0, "component 2"}, std::tuple{0.0, 2.0, "may be too small"},
        std::tuple{0.0, 0.2, "may be too large"}}) {
    EXPECT_THAT(all(quiet(factor, offset)), HasSubstr(words));
  }
}

TEST(Findings, TheWorstComesFirst) {
  Material m = quiet();
  m.imu_gaps.push_back({50.0, 0.2});
  m.states.back().resets = 2;
  m.score.nees_horizontal = {2, 1000, 30.0, {0.05, 7.38}, 0.2};
  m.score.horizontal_m = {1000, 5.0, 9.0, 12.0, 4.0};
  m.samples["dvl"] = 500;
  m.outages.push_back({30.0, 90.0, 1.0, 8.0, 16.0, 40.0});
  const auto found = findings(m);
  ASSERT_GE(found.size(), 5U);
  for (std::size_t i = 1; i < found.size(); ++i) EXPECT_LE(found[i - 1].weight, found[i].weight);
  EXPECT_EQ(found[0].weight, Finding::Weight::bad);
  const std::string text = all(m);
  EXPECT_THAT(text, HasSubstr("NEES is 30"));
  EXPECT_THAT(text, HasSubstr("dvl: none of 500 samples was used"));
  EXPECT_THAT(text, HasSubstr("The longest time without GPS was 60 s from 30 s on"));
  EXPECT_THAT(text, HasSubstr("In 1 of 1 outages"));
  EXPECT_THAT(text, HasSubstr("stepped 2 times"));
}

TEST(Findings, WithoutAlignmentOrPositionItSaysSo) {
  Material m = quiet();
  m.phases = {{0.0, AlignmentPhase::waiting}};
  for (StateRow& row : m.states) row.latitude_rad = kUnknown;
  EXPECT_THAT(all(m), HasSubstr("never had a position"));
  EXPECT_THAT(all(m), HasSubstr("never finished"));
  EXPECT_THAT(page(m), HasSubstr("There is no position to draw"));
}

TEST(Page, NeedsNothingFromElsewhere) {
  Material m = quiet();
  m.title = "<script>alert(1)</script>";
  const std::string html = page(m);
  for (const char* reach : {"http://", "https://", "src=", "@import", "url(", "<script", "<link"})
    EXPECT_THAT(html, Not(HasSubstr(reach)));
  EXPECT_THAT(html, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(html, HasSubstr("@media print"));
  EXPECT_THAT(html, Not(HasSubstr(">nan<")));
}

TEST(Source, KeepsAnEvenChoiceOfMany) {
  Source source;
  Verdict v;
  v.dimensions = 1;
  v.innovation_sigma[0] = 1.0;
  v.innovation[0] = 0.0;
  const auto many = static_cast<int>(3 * Source::kMostJudged);
  for (int i = 0; i < many; ++i) source.add(v, i);
  EXPECT_EQ(source.total(), static_cast<std::uint64_t>(many));
  EXPECT_LE(source.judged.size(), Source::kMostJudged);
  EXPECT_GT(source.judged.size(), Source::kMostJudged / 3);
  EXPECT_LT(source.judged.front().t_s, 10.0);
  EXPECT_GT(source.judged.back().t_s, many - 10.0);
}

}  // namespace
}  // namespace fathom::report
