// An engine that takes up what another one has saved goes on as that one does, to the last bit.

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "same_bits.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

struct Arrived {
  TimeNs at_ns;
  test::Sample sample;
};

/// The samples as they arrive where the aiding ones are held back by up to `longest_s`.
std::vector<Arrived> arrivals(const SurveyRun& run, std::uint64_t seed, double longest_s) {
  test::Normal random(seed);
  std::vector<Arrived> out;
  for (const test::Sample& sample : run.samples) {
    const bool imu = std::holds_alternative<ImuSample>(sample);
    const TimeNs late = imu ? 0 : from_seconds(random.uniform(0.0, longest_s));
    out.push_back(
        {std::max(test::header(sample).stamp_ns + late, SurveyRun::kEpochNs + (imu ? 0 : 1)), sample});
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.at_ns < b.at_ns; });
  return out;
}

using Judged = std::pair<TimeNs, SourceKind>;

/// What an engine says from an instant on.
struct Followed {
  std::vector<Judged> verdicts;
  NavState nav;
  NavDetail detail;
};

Followed follow(FusionEngine& engine, const std::vector<Arrived>& samples, std::size_t from) {
  Followed out;
  const auto drain = [&] {
    for (Verdict verdict; engine.next_verdict(verdict);) {
      out.verdicts.emplace_back(verdict.header.stamp_ns, verdict.source);
    }
  };
  for (std::size_t i = from; i < samples.size(); ++i) {
    test::feed(engine, samples[i].sample);
    drain();
  }
  engine.finish();
  drain();
  // What waits when it is saved is judged at once by the one and with the next inertial sample by the other.
  std::sort(out.verdicts.begin(), out.verdicts.end());
  out.nav = engine.nav_state();
  engine.fill(out.detail);
  return out;
}

void expect_same(const Followed& a, const Followed& b) {
  EXPECT_EQ(a.nav.header.sequence, b.nav.header.sequence);
  EXPECT_EQ(a.nav.mode, b.nav.mode);
  EXPECT_EQ(a.nav.alignment, b.nav.alignment);
  EXPECT_EQ(a.nav.reset_counter, b.nav.reset_counter);
  EXPECT_EQ(a.nav.latitude_rad, b.nav.latitude_rad);
  EXPECT_EQ(a.nav.longitude_rad, b.nav.longitude_rad);
  EXPECT_EQ(a.nav.altitude_m, b.nav.altitude_m);
  EXPECT_TRUE(same_bits(a.nav.velocity_N_m_s, b.nav.velocity_N_m_s));
  EXPECT_TRUE(same_bits(a.nav.q_NB, b.nav.q_NB));
  EXPECT_TRUE(same_bits(a.nav.position_covariance_N_m2, b.nav.position_covariance_N_m2));
  ASSERT_EQ(a.detail.count, b.detail.count);
  for (std::uint32_t i = 0; i < a.detail.count; ++i) {
    EXPECT_EQ(a.detail.states[i].value, b.detail.states[i].value) << i;
    EXPECT_EQ(a.detail.states[i].sigma, b.detail.states[i].sigma) << i;
  }
}

struct Case {
  const char* name;
  double longest_s;          ///< by which measurements are late
  std::size_t replay_steps;  ///< small: a second navigator makes up for late ones
};
class Checkpoint : public ::testing::TestWithParam<Case> {};

TEST_P(Checkpoint, GoesOnToTheLastBit) {
  const SurveyRun run({.duration_s = 58.0, .dive_s = 45.0});
  const auto samples = arrivals(run, 7, GetParam().longest_s);
  EngineConfig config = SurveyRun::config();
  config.replay_steps_per_sample = GetParam().replay_steps;
  // At rest, aligning, under way with GPS, and in the dive.
  for (const double share : {0.05, 0.3, 0.6, 0.85}) {
    const auto cut = static_cast<std::size_t>(share * static_cast<double>(samples.size()));
    FusionEngine first(config);
    for (std::size_t i = 0; i < cut; ++i) test::feed(first, samples[i].sample);
    std::vector<std::byte> image;
    ASSERT_TRUE(first.save(image));
    for (Verdict verdict; first.next_verdict(verdict);) continue;

    FusionEngine second(config);
    ASSERT_EQ(second.restore(image), "");
    EXPECT_EQ(second.nav_state().header.stamp_ns, first.nav_state().header.stamp_ns);
    // Before anything else has arrived: with the aiding that is in the image.
    Forecast foretold;
    second.fill(foretold);
    Forecast expected_forecast;
    first.fill(expected_forecast);
    EXPECT_EQ(foretold.limit_count, expected_forecast.limit_count);
    // What still waits in the one has acted in the other.
    EXPECT_EQ(std::isnan(foretold.horizontal_95_m), std::isnan(expected_forecast.horizontal_95_m));
    if (!std::isnan(foretold.horizontal_95_m)) {
      EXPECT_NEAR(foretold.horizontal_95_m / expected_forecast.horizontal_95_m, 1.0, 0.5);
    }
    const Followed expected = follow(first, samples, cut);
    const Followed got = follow(second, samples, cut);
    SCOPED_TRACE(share);
    expect_same(got, expected);
    EXPECT_FALSE(expected.verdicts.empty());
    EXPECT_EQ(got.verdicts, expected.verdicts);
  }
}

INSTANTIATE_TEST_SUITE_P(Lateness, Checkpoint,
                         ::testing::Values(Case{"punctual", 0.0, 200}, Case{"late", 0.6, 10'000},
                                           Case{"made_up_for", 3.0, 4}),
                         [](const auto& info) { return info.param.name; });

TEST(Checkpoint, NothingIsSavedBeforeTheFirstInertialSample) {
  FusionEngine engine(SurveyRun::config());
  std::vector<std::byte> image;
  EXPECT_FALSE(engine.save(image));
  EXPECT_TRUE(image.empty());
}

TEST(Checkpoint, WhatIsNoImageChangesNothing) {
  const SurveyRun run({.duration_s = 20.0});
  FusionEngine engine(SurveyRun::config());
  for (const test::Sample& sample : run.samples) test::feed(engine, sample);
  std::vector<std::byte> image;
  ASSERT_TRUE(engine.save(image));
  const NavState before = engine.nav_state();
  for (const std::size_t size : {std::size_t{0}, std::size_t{8}, image.size() / 2, image.size() - 1}) {
    EXPECT_NE(engine.restore(std::span(image).first(size)), "") << size;
  }
  std::vector<std::byte> longer = image;
  longer.push_back({});
  EXPECT_NE(engine.restore(longer), "");
  std::vector<std::byte> other = image;
  other.front() ^= std::byte{1};
  EXPECT_NE(engine.restore(other), "");
  std::vector<std::byte> wild = image;  // at its end stand the measurements that are held
  std::fill(wild.end() - 100, wild.end(), std::byte{0xff});
  EXPECT_NE(engine.restore(wild), "");
  EXPECT_EQ(engine.nav_state().latitude_rad, before.latitude_rad);
  EXPECT_EQ(engine.nav_state().header.sequence, before.header.sequence);
  EXPECT_EQ(engine.restore(image), "");
}

TEST(Checkpoint, AfterAGapTheUncertaintyGrowsAndNothingIsAlignedAnew) {
  const SurveyRun run({.duration_s = 70.0, .dive_s = 45.0});
  const TimeNs saved_ns = SurveyRun::kEpochNs + from_seconds(55.0);
  const TimeNs back_ns = saved_ns + from_seconds(1.5);
  FusionEngine uninterrupted(SurveyRun::config());
  FusionEngine restarted(SurveyRun::config());
  std::vector<std::byte> image;
  for (const test::Sample& sample : run.samples) {
    const TimeNs at_ns = test::header(sample).received_ns;
    if (at_ns > saved_ns && image.empty()) {
      ASSERT_TRUE(uninterrupted.save(image));
      ASSERT_EQ(restarted.restore(image), "");
      ASSERT_EQ(restarted.nav_state().alignment, AlignmentPhase::aligned);
    }
    test::feed(uninterrupted, sample);
    if (at_ns <= back_ns) continue;
    test::feed(restarted, sample);
    ASSERT_GT(restarted.nav_state().mode, NavMode::aligning);
    ASSERT_GE(restarted.nav_state().alignment, AlignmentPhase::fine) << "it may have turned unseen";
    ASSERT_LE(restarted.nav_state().alignment, AlignmentPhase::aligned);
  }
  ASSERT_FALSE(image.empty());
  const NavState& a = uninterrupted.nav_state();
  const NavState& b = restarted.nav_state();
  const auto apart = geo::difference_N({a.latitude_rad, a.longitude_rad, a.altitude_m},
                                       {b.latitude_rad, b.longitude_rad, b.altitude_m});
  const double sigma_m = std::sqrt(b.position_covariance_N_m2[0] + b.position_covariance_N_m2[4]);
  EXPECT_LT(std::hypot(apart.x(), apart.y()), 3.0 * sigma_m);
  EXPECT_GT(b.position_covariance_N_m2[0], a.position_covariance_N_m2[0]);
}

}  // namespace
}  // namespace fathom::estimation
