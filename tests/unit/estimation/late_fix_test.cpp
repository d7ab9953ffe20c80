// Fixes that come minutes late: against an engine that had them in time, and what becomes of wrong ones.

#include <cstring>
#include <map>
#include <optional>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "estimation/engine/fusion_engine.hpp"
#include "support/sanitized.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using test::Normal;
using test::SurveyRun;

constexpr double kDive_s = 50.0;

EngineConfig config_with(double memory_s) {
  EngineConfig config = SurveyRun::config();
  config.sensors.push_back(default_sensor(SourceKind::fix, "operator"));
  config.late_fix_memory_s = memory_s;
  return config;
}

/// Where the vehicle was at `t_s`, wrong by `error_N_m`.
FixSample fix_at(const SurveyRun& survey, double t_s, double told_s, double sigma_m,
                 const Vector3d& error_N_m) {
  const Truth& truth = survey.truth[static_cast<std::size_t>(std::lround(100.0 * t_s))];
  FixSample out;
  const auto instant = [](double s) { return SurveyRun::kEpochNs + from_seconds(s); };
  out.header = {"auv", "operator", instant(t_s), instant(told_s), 1};
  const geo::Geodetic place =
      geo::moved_by({truth.latitude_rad, truth.longitude_rad, truth.altitude_m}, error_N_m);
  out.latitude_rad = place.latitude_rad;
  out.longitude_rad = place.longitude_rad;
  out.sigma_m = sigma_m;
  return out;
}

struct Outcome {
  NavState end;
  Eigen::Matrix<double, 9, 9> covariance;
  std::vector<Verdict> verdicts;  ///< final ones of fixes
  Vector3d error_N_m;
  std::uint32_t resets_before = 0;
  [[nodiscard]] double sigma_m() const { return std::sqrt(covariance(0, 0) + covariance(1, 1)); }
  [[nodiscard]] double nees() const {
    const Eigen::Matrix2d p = covariance.topLeftCorner<2, 2>();
    const Eigen::Vector2d e = error_N_m.head<2>();
    return e.dot(p.inverse() * e);
  }
};

/// Feeds fixes where they are received, `delay_s` later.
struct Way {
  double delay_s = 0.0;          ///< from when a fix is received to when the engine has it
  bool through_archive = false;  ///< at 350 s another engine goes on
  double dvl_lost_s = 0.0;       ///< from 100 s on there is no Doppler log for so long
};
Outcome run(const SurveyRun& survey, const EngineConfig& config, const std::vector<FixSample>& fixes,
            const Way& way = {}) {
  auto engine = std::make_unique<FusionEngine>(config);
  Outcome out;
  std::vector<bool> given(fixes.size(), false);
  Verdict verdict;
  bool saved = false;
  const auto drain = [&] {
    while (engine->next_verdict(verdict))
      if (verdict.source == SourceKind::fix && verdict.is_final) out.verdicts.push_back(verdict);
  };
  for (const test::Sample& sample : survey.samples) {
    const TimeNs now = test::header(sample).received_ns;
    for (std::size_t i = 0; i < fixes.size(); ++i)
      if (!given[i] && fixes[i].header.received_ns + from_seconds(way.delay_s) <= now) {
        if (i == 0) out.resets_before = engine->nav_state().reset_counter;
        engine->add(fixes[i], "hand");
        given[i] = true;
      }
    const double t_s = to_seconds(test::header(sample).stamp_ns - SurveyRun::kEpochNs);
    const bool lost =
        std::holds_alternative<DvlSample>(sample) && t_s > 100.0 && t_s < 100.0 + way.dvl_lost_s;
    if (!lost) test::feed(*engine, sample);
    drain();
    if (way.through_archive && !saved && now > SurveyRun::kEpochNs + from_seconds(350.0)) {
      std::vector<std::byte> bytes;
      EXPECT_TRUE(engine->save(bytes));
      engine = std::make_unique<FusionEngine>(config);
      EXPECT_EQ(engine->restore(bytes), "");
      saved = true;
    }
  }
  out.end = engine->nav_state();
  out.covariance = engine->navigation_covariance();
  engine->finish();
  drain();
  const Truth& truth = survey.truth.back();
  out.error_N_m = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                    {out.end.latitude_rad, out.end.longitude_rad, out.end.altitude_m});
  return out;
}

Vector3d between(const Outcome& a, const Outcome& b) {
  return geo::difference_N({a.end.latitude_rad, a.end.longitude_rad, a.end.altitude_m},
                           {b.end.latitude_rad, b.end.longitude_rad, b.end.altitude_m});
}

bool same_bits(const NavState& a, const NavState& b) {
  return a.latitude_rad == b.latitude_rad && a.longitude_rad == b.longitude_rad &&
         a.altitude_m == b.altitude_m && a.position_covariance_N_m2 == b.position_covariance_N_m2 &&
         a.velocity_N_m_s == b.velocity_N_m_s && a.q_NB == b.q_NB;
}

TEST(LateFix, ActsAsOneThatCameInTime) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const SurveyRun survey({.duration_s = 500.0, .dive_s = kDive_s, .seed = seed, .usbl = false});
    const EngineConfig config = config_with(900.0);
    const Vector3d error(1.0, -1.0, 0.0);
    const Outcome none = run(survey, config, {});
    const Outcome punctual = run(survey, config, {fix_at(survey, 300.0, 300.5, 1.0, error)});
    const Outcome late = run(survey, config, {fix_at(survey, 300.0, 480.0, 1.0, error)});
    ASSERT_EQ(late.verdicts.size(), 1U);
    EXPECT_EQ(late.verdicts[0].kind, VerdictKind::used);
    const double moved_m = between(none, punctual).head<2>().norm();
    EXPECT_GT(moved_m, 0.5) << "the fix says nothing new";
    // What is considered gets no gain (KF-6), so that the order counts a little.
    EXPECT_LT(between(punctual, late).norm(), 0.02 * moved_m) << seed;
    EXPECT_NEAR(late.sigma_m(), punctual.sigma_m(), 0.002 * punctual.sigma_m()) << seed;
    EXPECT_LT(late.sigma_m(), 0.9 * none.sigma_m()) << seed;
  }
}

TEST(LateFix, SeveralInAnyOrderActAsIfTheyHadComeInTime) {
  const SurveyRun survey({.duration_s = 700.0, .dive_s = kDive_s, .seed = 4, .usbl = false});
  const EngineConfig config = config_with(900.0);
  const std::vector<double> instants{150.0, 420.0, 260.0, 330.0};
  std::vector<FixSample> punctual;
  std::vector<FixSample> late;
  Normal normal(9);
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const Vector3d error = normal.vector(4.0);
    punctual.push_back(fix_at(survey, instants[i], instants[i] + 0.5, 4.0, error));
    late.push_back(fix_at(survey, instants[i], 500.0 + 40.0 * static_cast<double>(i), 4.0, error));
  }
  const Outcome none = run(survey, config, {});
  const Outcome in_time = run(survey, config, punctual);
  const Outcome out = run(survey, config, late);
  EXPECT_EQ(out.verdicts.size(), instants.size());
  for (const Verdict& one : out.verdicts) EXPECT_EQ(one.kind, VerdictKind::used);
  EXPECT_LT(between(in_time, out).head<2>().norm(), 0.05 * between(none, in_time).head<2>().norm() + 0.1);
  EXPECT_NEAR(out.sigma_m(), in_time.sigma_m(), 0.03 * in_time.sigma_m());
}

TEST(LateFix, AWrongOneIsRefusedAndSaysByHowMuch) {
  const SurveyRun survey({.duration_s = 500.0, .dive_s = kDive_s, .seed = 5, .usbl = false});
  const EngineConfig config = config_with(900.0);
  const Outcome none = run(survey, config, {});
  const Outcome out = run(survey, config, {fix_at(survey, 200.0, 480.0, 20.0, {0.0, 1000.0, 0.0})});
  ASSERT_EQ(out.verdicts.size(), 1U);
  const Verdict& verdict = out.verdicts[0];
  EXPECT_EQ(verdict.kind, VerdictKind::rejected);
  EXPECT_EQ(verdict.model, Name("fix_position"));
  EXPECT_EQ(verdict.writer, Name("hand"));
  EXPECT_NEAR(verdict.innovation[1], -1000.0, 60.0);
  EXPECT_GT(verdict.test_ratio, 50.0);
  // All that it leaves is where the covariance made its strides (KF-1).
  EXPECT_LT(between(none, out).norm(), 1e-6);
  EXPECT_NEAR(out.sigma_m(), none.sigma_m(), 1e-6 * none.sigma_m());
  EXPECT_EQ(out.end.reset_counter, none.end.reset_counter);
}

TEST(LateFix, WhatWasToldWronglyMayBeToldAgainButNotWhatWasUsed) {
  const SurveyRun survey({.duration_s = 300.0, .dive_s = kDive_s, .seed = 12, .usbl = false});
  std::vector<FixSample> fixes{fix_at(survey, 200.0, 280.0, 5.0, {0.0, 1000.0, 0.0}),
                               fix_at(survey, 200.0, 285.0, 5.0, {1.0, 1.0, 0.0}),
                               fix_at(survey, 200.0, 290.0, 5.0, {1.0, 1.0, 0.0})};
  const Outcome out = run(survey, config_with(900.0), fixes);
  ASSERT_EQ(out.verdicts.size(), 3U);
  EXPECT_EQ(out.verdicts[0].kind, VerdictKind::rejected);
  EXPECT_EQ(out.verdicts[1].kind, VerdictKind::used);
  EXPECT_EQ(out.verdicts[2].kind, VerdictKind::duplicate);
}

TEST(LateFix, OlderThanWhatIsRememberedIsLate) {
  const SurveyRun survey({.duration_s = 300.0, .dive_s = kDive_s, .seed = 6, .usbl = false});
  const Outcome out = run(survey, config_with(100.0), {fix_at(survey, 100.0, 290.0, 5.0, Vector3d::Zero())});
  ASSERT_EQ(out.verdicts.size(), 1U);
  EXPECT_EQ(out.verdicts[0].kind, VerdictKind::late);
  // Nor is anything remembered of the time before there was navigation.
  const Outcome early = run(survey, config_with(900.0), {fix_at(survey, 2.0, 290.0, 5.0, Vector3d::Zero())});
  ASSERT_EQ(early.verdicts.size(), 1U);
  EXPECT_EQ(early.verdicts[0].kind, VerdictKind::late);
  // Without memory a fix acts at its instant or not at all.
  const Outcome without =
      run(survey, config_with(0.0), {fix_at(survey, 200.0, 290.0, 5.0, Vector3d::Zero())});
  ASSERT_EQ(without.verdicts.size(), 1U);
  EXPECT_EQ(without.verdicts[0].kind, VerdictKind::late);
}

TEST(LateFix, TheMemoryChangesNothing) {
  const SurveyRun survey({.duration_s = 200.0, .dive_s = kDive_s, .seed = 7, .usbl = false});
  EXPECT_TRUE(same_bits(run(survey, SurveyRun::config(), {}).end, run(survey, config_with(900.0), {}).end));
}

TEST(LateFix, ArrivesWheneverAndGivesTheSameBits) {
  const SurveyRun survey({.duration_s = 480.0, .dive_s = kDive_s, .seed = 8, .usbl = false});
  const EngineConfig config = config_with(900.0);
  const std::vector<FixSample> fixes{fix_at(survey, 200.0, 440.0, 5.0, {4.0, 2.0, 0.0}),
                                     fix_at(survey, 300.0, 440.3, 5.0, {-1.0, 2.0, 0.0}),
                                     fix_at(survey, 250.0, 460.0, 5.0, {1.0, -3.0, 0.0})};
  const Outcome first = run(survey, config, fixes);
  for (const double delay_s : {0.7, 2.5, 4.5}) {
    const Outcome again = run(survey, config, fixes, {.delay_s = delay_s});
    EXPECT_TRUE(same_bits(first.end, again.end)) << delay_s;
  }
  std::vector<FixSample> turned(fixes.rbegin(), fixes.rend());
  EXPECT_TRUE(same_bits(first.end, run(survey, config, turned, {.delay_s = 3.0}).end));
}

TEST(LateFix, IsPartOfASavedState) {
  const SurveyRun survey({.duration_s = 480.0, .dive_s = kDive_s, .seed = 9, .usbl = false});
  const EngineConfig config = config_with(900.0);
  const std::vector<FixSample> fixes{fix_at(survey, 200.0, 300.0, 5.0, {4.0, 2.0, 0.0}),
                                     fix_at(survey, 150.0, 440.0, 5.0, {-1.0, 2.0, 0.0})};
  const Outcome whole = run(survey, config, fixes);
  const Outcome parted = run(survey, config, fixes, {.through_archive = true});
  EXPECT_TRUE(same_bits(whole.end, parted.end));
  ASSERT_EQ(whole.verdicts.size(), 2U);
  EXPECT_EQ(whole.verdicts[1].kind, VerdictKind::used);
}

TEST(LateFix, AStepIsCountedAndTold) {
  const SurveyRun survey({.duration_s = 480.0, .dive_s = kDive_s, .seed = 10, .usbl = false});
  const EngineConfig config = config_with(900.0);
  const Outcome out = run(survey, config, {fix_at(survey, 300.0, 440.0, 3.0, {6.0, 6.0, 0.0})});
  EXPECT_EQ(out.end.reset_counter, out.resets_before + 1);
}

TEST(LateFix, OfTenMinutesAgoHelpsADeadReckonedSurveyAsOneInTimeWouldHave) {
  FATHOM_MANY_RUNS();
  // Minutes without the Doppler log: from then on navigation is wrong by tens of metres.
  const Way way{.dvl_lost_s = 280.0};
  constexpr int kRuns = 8;
  const EngineConfig config = config_with(900.0);
  double in_time = 0.0;
  double late = 0.0;
  double nees = 0.0;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    const SurveyRun survey({.duration_s = 1000.0, .dive_s = kDive_s, .seed = 200 + seed, .usbl = false});
    Normal normal(700 + seed);
    Vector3d error = normal.vector(20.0);
    error.z() = 0.0;
    const Outcome punctual = run(survey, config, {fix_at(survey, 390.0, 390.5, 20.0, error)}, way);
    const Outcome out = run(survey, config, {fix_at(survey, 390.0, 990.0, 20.0, error)}, way);
    EXPECT_NEAR(out.sigma_m(), punctual.sigma_m(), 0.2 * punctual.sigma_m()) << seed;
    EXPECT_LT(between(out, punctual).norm(), 0.2 * punctual.sigma_m()) << seed;
    if (seed == 0) {
      EXPECT_LT(out.sigma_m(), 0.8 * run(survey, config, {}, way).sigma_m());
    }
    in_time += punctual.error_N_m.head<2>().squaredNorm() / kRuns;
    late += out.error_N_m.head<2>().squaredNorm() / kRuns;
    nees += out.nees() / kRuns;
  }
  EXPECT_NEAR(std::sqrt(late), std::sqrt(in_time), 0.2 * std::sqrt(in_time));
  // Of 2 degrees of freedom over 8 runs: 99 % lie within 0.64 and 4.3.
  EXPECT_GT(nees, 0.64);
  EXPECT_LT(nees, 4.3);
}

}  // namespace
}  // namespace fathom::estimation
