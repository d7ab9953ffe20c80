#include <cstring>

#include <gtest/gtest.h>

#include "support/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

/// Arrival order in which each aiding sample is held back by a random time, and the inertial samples are not.
std::vector<test::Sample> shuffled(const SurveyRun& run, std::uint64_t seed, double longest_s) {
  test::Normal random(seed);
  std::vector<std::pair<TimeNs, test::Sample>> timed;
  timed.reserve(run.samples.size());
  for (const test::Sample& sample : run.samples) {
    const SampleHeader& header = test::header(sample);
    const bool imu = std::holds_alternative<ImuSample>(sample);
    const TimeNs arrival = header.stamp_ns + (imu ? 0 : from_seconds(random.uniform(-0.4, longest_s)));
    // What comes before the first inertial sample cannot be placed in time.
    timed.emplace_back(std::max(arrival, SurveyRun::kEpochNs + (imu ? 0 : 1)), sample);
  }
  std::stable_sort(timed.begin(), timed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<test::Sample> out;
  out.reserve(timed.size());
  for (auto& one : timed) out.push_back(std::move(one.second));
  return out;
}

/// Feeds the aiding samples stamped before `until` and all inertial samples.
NavState final_state(const std::vector<test::Sample>& samples, TimeNs until, NavDetail& detail) {
  FusionEngine engine(SurveyRun::config());
  for (const test::Sample& sample : samples)
    if (std::holds_alternative<ImuSample>(sample) || test::header(sample).stamp_ns < until)
      test::feed(engine, sample);
  engine.fill(detail);
  return engine.nav_state();
}

template <std::size_t N>
bool same_bits(const std::array<double, N>& a, const std::array<double, N>& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

TEST(Order, OfArrivalDoesNotChangeASingleBit) {
  const SurveyRun run({.duration_s = 58.0, .dive_s = 45.0});
  // Everything stamped before this has arrived when the last inertial sample does.
  const TimeNs until = run.truth.back().header.stamp_ns - from_seconds(4.9);
  NavDetail expected_detail;
  const NavState expected = final_state(shuffled(run, 0, 0.0), until, expected_detail);
  ASSERT_GE(expected.mode, NavMode::gps_aided);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    NavDetail detail;
    const NavState nav = final_state(shuffled(run, seed, 4.8), until, detail);
    EXPECT_EQ(nav.latitude_rad, expected.latitude_rad) << seed;
    EXPECT_EQ(nav.longitude_rad, expected.longitude_rad) << seed;
    EXPECT_EQ(nav.altitude_m, expected.altitude_m) << seed;
    EXPECT_TRUE(same_bits(nav.velocity_N_m_s, expected.velocity_N_m_s)) << seed;
    EXPECT_TRUE(same_bits(nav.q_NB, expected.q_NB)) << seed;
    EXPECT_TRUE(same_bits(nav.position_covariance_N_m2, expected.position_covariance_N_m2)) << seed;
    EXPECT_EQ(nav.alignment, expected.alignment);
    ASSERT_EQ(detail.count, expected_detail.count);
    for (std::uint32_t i = 0; i < detail.count; ++i) {
      EXPECT_EQ(detail.states[i].value, expected_detail.states[i].value) << seed << ' ' << i;
      EXPECT_EQ(detail.states[i].sigma, expected_detail.states[i].sigma) << seed << ' ' << i;
    }
  }
}

TEST(Order, OfManyShortPermutations) {
  // The first ten seconds after the start, over and over.
  const SurveyRun run({.duration_s = 16.0, .dive_s = 14.0, .usbl = false});
  const TimeNs until = run.truth.back().header.stamp_ns - from_seconds(3.0);
  NavDetail expected_detail;
  const NavState expected = final_state(shuffled(run, 0, 0.0), until, expected_detail);
  for (std::uint64_t seed = 100; seed < 130; ++seed) {
    NavDetail detail;
    const NavState nav = final_state(shuffled(run, seed, 2.9), until, detail);
    ASSERT_EQ(nav.latitude_rad, expected.latitude_rad) << seed;
    ASSERT_TRUE(same_bits(nav.q_NB, expected.q_NB)) << seed;
    ASSERT_TRUE(same_bits(nav.velocity_covariance_N_m2_s2, expected.velocity_covariance_N_m2_s2)) << seed;
  }
}

}  // namespace
}  // namespace fathom::estimation
