// The smoother over a simulated survey: better than the filter, honest, repeatable, and blind across resets.
#include "estimation/smoothing/smoother.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "support/sanitized.hpp"
#include "support/vehicles/spoilt_survey.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

struct Result {
  std::vector<NavState> filtered;
  std::vector<NavState> smoothed;  ///< in the order of time
  std::vector<Verdict> verdicts;
};

Result smooth(const std::vector<test::Sample>& samples, const EngineConfig& config,
              const std::function<void(Smoother&, const test::Sample&)>& after = {}) {
  Smoother smoother(config);
  for (const test::Sample& sample : samples) {
    std::visit([&](const auto& s) { smoother.add(s); }, sample);
    if (after) after(smoother, sample);
  }
  Result result;
  Smoother::Output output;
  output.verdict = [&](const Verdict& verdict) { result.verdicts.push_back(verdict); };
  output.filtered = [&](const NavState& state) { result.filtered.push_back(state); };
  output.smoothed = [&](const NavState& state) { result.smoothed.push_back(state); };
  smoother.run(output);
  std::reverse(result.smoothed.begin(), result.smoothed.end());
  return result;
}

struct Errors {
  double horizontal_rms_m = 0.0;
  double velocity_rms_m_s = 0.0;
  double yaw_rms_rad = 0.0;
  double nees_horizontal = 0.0;  ///< mean; consistent: 2
  double nees_velocity = 0.0;    ///< mean, north and east; consistent: 2
};

double nees2(double a, double b, const std::array<double, 9>& p) {
  const double det = p[0] * p[4] - p[1] * p[1];
  return (p[4] * a * a - 2.0 * p[1] * a * b + p[0] * b * b) / det;
}

Errors errors(const SurveyRun& run, const std::vector<NavState>& states, double from_s, double to_s) {
  Errors out;
  double count = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const NavState& nav = states[i];
    const Truth& truth = run.truth[i];
    EXPECT_EQ(nav.header.stamp_ns, truth.header.stamp_ns);
    const double t = to_seconds(nav.header.stamp_ns - SurveyRun::kEpochNs);
    if (t < from_s || t > to_s || !known(nav.latitude_rad)) continue;
    const Eigen::Vector3d d = geo::difference_N({nav.latitude_rad, nav.longitude_rad, nav.altitude_m},
                                                {truth.latitude_rad, truth.longitude_rad, truth.altitude_m});
    const double vn = nav.velocity_N_m_s[0] - truth.velocity_N_m_s[0];
    const double ve = nav.velocity_N_m_s[1] - truth.velocity_N_m_s[1];
    out.horizontal_rms_m += d.x() * d.x() + d.y() * d.y();
    out.velocity_rms_m_s += vn * vn + ve * ve;
    out.yaw_rms_rad += std::pow(std::remainder(nav.rpy_rad[2] - truth.rpy_rad[2], 2.0 * M_PI), 2);
    out.nees_horizontal += nees2(d.x(), d.y(), nav.position_covariance_N_m2);
    out.nees_velocity += nees2(vn, ve, nav.velocity_covariance_N_m2_s2);
    count += 1.0;
  }
  EXPECT_GT(count, 0.0);
  for (double* sum : {&out.horizontal_rms_m, &out.velocity_rms_m_s, &out.yaw_rms_rad})
    *sum = std::sqrt(*sum / count);
  out.nees_horizontal /= count;
  out.nees_velocity /= count;
  return out;
}

SurveyRun::Options outage_in_the_middle(std::uint64_t seed) {
  SurveyRun::Options options;
  options.seed = seed;
  options.duration_s = 150.0;
  options.dive_s = 50.0;
  options.surface_s = 120.0;
  options.usbl = false;
  return options;
}

/// The survey's instruments without the one that bounds the growth of the error.
EngineConfig without_dvl() {
  EngineConfig config = SurveyRun::config();
  for (SensorConfig& sensor : config.sensors) sensor.enabled = sensor.kind != SourceKind::dvl;
  return config;
}

/// The survey's configuration with the very statistics that the simulated errors are drawn from, so that the
/// consistency of the estimate is a statement about the smoother and not about the configuration.
EngineConfig truthful() {
  EngineConfig config = SurveyRun::config();
  const SurveyRun::Options drawn;
  config.groups.gps_position_bias = false;
  config.left_out = LeftOut::noise;
  config.imu.gyro_bias_sigma_rad_s = drawn.gyro_bias_rad_s;
  config.imu.accel_bias_sigma_m_s2 = drawn.accel_bias_m_s2;
  config.imu.gyro_bias_instability_rad_s = 1e-9;
  config.imu.accel_bias_instability_m_s2 = 1e-6;
  config.states.dvl_scale_sigma = 0.002;
  config.states.dvl_misalignment_sigma_rad = 0.005;
  config.states.heading_bias_sigma_rad = 0.012;
  config.states.heading_bias_time_constant_s = 0.0;
  return config;
}

TEST(Smoother, IsBetterThanTheFilterAndKnowsHowGoodItIs) {
  FATHOM_MANY_RUNS();
  constexpr int kRuns = 6;
  Errors filter;
  Errors smoother;
  const auto pool = [](Errors& sum, const Errors& one) {
    sum.horizontal_rms_m = std::hypot(sum.horizontal_rms_m, one.horizontal_rms_m / std::sqrt(kRuns));
    sum.velocity_rms_m_s = std::hypot(sum.velocity_rms_m_s, one.velocity_rms_m_s / std::sqrt(kRuns));
    sum.yaw_rms_rad = std::hypot(sum.yaw_rms_rad, one.yaw_rms_rad / std::sqrt(kRuns));
    sum.nees_horizontal += one.nees_horizontal / kRuns;
    sum.nees_velocity += one.nees_velocity / kRuns;
  };
  for (int k = 1; k <= kRuns; ++k) {
    SurveyRun::Options options = outage_in_the_middle(static_cast<std::uint64_t>(k));
    options.duration_s = 110.0;
    options.surface_s = 90.0;
    const SurveyRun run(options);
    const Result result = smooth(run.samples, truthful());
    pool(filter, errors(run, result.filtered, 20.0, 110.0));
    pool(smoother, errors(run, result.smoothed, 20.0, 110.0));
  }
  EXPECT_LT(smoother.horizontal_rms_m, 0.75 * filter.horizontal_rms_m);
  EXPECT_LT(smoother.velocity_rms_m_s, 0.75 * filter.velocity_rms_m_s);
  EXPECT_LT(smoother.yaw_rms_rad, 0.75 * filter.yaw_rms_rad);
  // 95 % of means over six runs of two degrees of freedom, should a run be a single draw: chi-square of 12
  // over 6.
  for (const double nees : {smoother.nees_horizontal, smoother.nees_velocity}) {
    EXPECT_GT(nees, 4.40 / 6.0);
    EXPECT_LT(nees, 23.34 / 6.0);
  }
}

TEST(Smoother, HoldsAnOutageFromBothEnds) {
  const SurveyRun run(outage_in_the_middle(3));
  const Result result = smooth(run.samples, without_dvl());
  const Errors f = errors(run, result.filtered, 60.0, 122.0);
  const Errors s = errors(run, result.smoothed, 60.0, 122.0);
  EXPECT_LT(s.horizontal_rms_m, f.horizontal_rms_m / 3.0);
}

// What is found of the start (GATE-9) was so before it was found (SMOOTH-6): the vehicle leaves at 20 s.
TEST(Smoother, AHeadingThatWasWrongAtTheStartIsRightFromTheStart) {
  const SurveyRun run({.duration_s = 120.0});
  std::vector<test::Sample> spoilt = run.samples;
  for (test::Sample& sample : spoilt)
    test::turn_compass(sample, test::seconds_of(sample), 20.0 * kRadPerDeg, 0.0, 45.0);
  const Result result = smooth(spoilt, SurveyRun::config());
  const Errors filtered = errors(run, result.filtered, 12.0, 28.0);
  const Errors smoothed = errors(run, result.smoothed, 12.0, 28.0);
  EXPECT_GT(filtered.yaw_rms_rad, 10.0 * kRadPerDeg);
  EXPECT_LT(smoothed.yaw_rms_rad, 2.0 * kRadPerDeg);
  // In place of the forward pass's 30 to 50 while GPS was refused.
  EXPECT_GT(errors(run, result.filtered, 24.0, 32.0).nees_horizontal, 20.0);
  EXPECT_LT(errors(run, result.smoothed, 24.0, 32.0).nees_horizontal, 7.4);
}

TEST(Smoother, AgreesWithTheFilterAtTheEnd) {
  const SurveyRun run(outage_in_the_middle(5));
  const Result result = smooth(run.samples, SurveyRun::config());
  ASSERT_EQ(result.smoothed.size(), result.filtered.size());
  EXPECT_EQ(result.smoothed.back().latitude_rad, result.filtered.back().latitude_rad);
  EXPECT_EQ(result.smoothed.back().position_covariance_N_m2, result.filtered.back().position_covariance_N_m2);
  for (std::size_t i = 0; i < result.smoothed.size(); ++i) {
    if (!known(result.filtered[i].latitude_rad)) continue;
    // Later measurements never make anything less certain.
    for (const std::size_t axis : {0U, 4U, 8U}) {
      EXPECT_LE(result.smoothed[i].position_covariance_N_m2[axis],
                result.filtered[i].position_covariance_N_m2[axis] * (1.0 + 1e-9));
      EXPECT_LE(result.smoothed[i].velocity_covariance_N_m2_s2[axis],
                result.filtered[i].velocity_covariance_N_m2_s2[axis] * (1.0 + 1e-9));
    }
  }
}

TEST(Smoother, DependsNeitherOnTheOrderOfArrivalNorOnTheRun) {
  SurveyRun::Options options = outage_in_the_middle(2);
  options.usbl = true;
  options.duration_s = 90.0;
  const SurveyRun run(options);
  std::vector<test::Sample> punctual = run.samples;
  std::stable_sort(punctual.begin(), punctual.end(), [](const test::Sample& a, const test::Sample& b) {
    return test::header(a).stamp_ns < test::header(b).stamp_ns;
  });
  // Far later than the engine's horizon allows.
  std::vector<test::Sample> belated = punctual;
  std::stable_partition(belated.begin(), belated.end(),
                        [](const test::Sample& s) { return std::holds_alternative<ImuSample>(s); });
  const Result a = smooth(run.samples, SurveyRun::config());
  const Result b = smooth(punctual, SurveyRun::config());
  const Result c = smooth(belated, SurveyRun::config());
  ASSERT_EQ(a.smoothed.size(), b.smoothed.size());
  ASSERT_EQ(a.smoothed.size(), c.smoothed.size());
  for (std::size_t i = 0; i < a.smoothed.size(); ++i) {
    for (const Result* other : {&b, &c}) {
      const NavState& x = a.smoothed[i];
      const NavState& y = other->smoothed[i];
      ASSERT_EQ(std::memcmp(&x.latitude_rad, &y.latitude_rad, sizeof(double)), 0) << i;
      ASSERT_EQ(std::memcmp(&x.rpy_rad, &y.rpy_rad, sizeof x.rpy_rad), 0) << i;
      ASSERT_EQ(std::memcmp(&x.position_covariance_N_m2, &y.position_covariance_N_m2,
                            sizeof x.position_covariance_N_m2),
                0)
          << i;
    }
  }
  // Each measurement has one verdict, and the order of arrival does not change it.
  ASSERT_EQ(a.verdicts.size(), c.verdicts.size());
  for (std::size_t i = 0; i < a.verdicts.size(); ++i) EXPECT_EQ(a.verdicts[i].kind, c.verdicts[i].kind);
}

TEST(Smoother, GivesEachMeasurementOneVerdict) {
  SurveyRun::Options options = outage_in_the_middle(4);
  options.duration_s = 60.0;
  const SurveyRun run(options);
  std::vector<test::Sample> samples = run.samples;
  const auto add = [&](TimeNs stamp_ns, std::uint64_t sequence, const char* sensor) {
    DepthSample depth;
    depth.header.sensor = sensor;
    depth.header.stamp_ns = stamp_ns;
    depth.header.sequence = sequence;
    depth.depth_m = 0.0;
    samples.emplace_back(depth);
  };
  add(SurveyRun::kEpochNs - kNsPerSecond, 1'000'000, "depth0");       // before everything
  add(SurveyRun::kEpochNs + 70 * kNsPerSecond, 1'000'001, "depth0");  // behind everything
  add(SurveyRun::kEpochNs + 30 * kNsPerSecond + 1, 1'000'002, "depth0");
  add(SurveyRun::kEpochNs + 30 * kNsPerSecond + 1, 1'000'002, "depth0");  // twice
  add(SurveyRun::kEpochNs + 30 * kNsPerSecond, 1'000'003, "depth9");      // not configured
  const Result result = smooth(samples, SurveyRun::config());
  std::size_t aiding = 0;
  for (const test::Sample& sample : samples) aiding += std::holds_alternative<ImuSample>(sample) ? 0 : 1;
  EXPECT_EQ(result.verdicts.size(), aiding);
  const auto count = [&](VerdictKind kind) {
    return std::count_if(result.verdicts.begin(), result.verdicts.end(),
                         [&](const Verdict& v) { return v.kind == kind; });
  };
  EXPECT_EQ(count(VerdictKind::from_the_future), 1);
  EXPECT_EQ(count(VerdictKind::duplicate), 1);
  EXPECT_EQ(count(VerdictKind::source_disabled), 1);
  EXPECT_GT(count(VerdictKind::used), 1000);
}

TEST(Smoother, WhatHasNoSoundStampIsRefusedAndStopsNothing) {
  const SurveyRun run({.duration_s = 40.0, .dive_s = 1e9});
  const Result plain = smooth(run.samples, SurveyRun::config());
  constexpr TimeNs kEnds[] = {std::numeric_limits<TimeNs>::min(), std::numeric_limits<TimeNs>::max()};
  std::vector<test::Sample> samples;
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    for (const TimeNs stamp_ns : kEnds) {
      if (i != 0 && i != run.samples.size() / 2) continue;
      // A unit that is well in everything else, and an instrument likewise.
      ImuSample imu =
          std::get<ImuSample>(*std::find_if(run.samples.begin(), run.samples.end(), [](auto& one) {
            return std::holds_alternative<ImuSample>(one);
          }));
      imu.header.stamp_ns = stamp_ns;
      samples.emplace_back(imu);
      DepthSample depth;
      depth.header = {"auv", "depth0", stamp_ns, stamp_ns, 1'000'000};
      samples.emplace_back(depth);
    }
    samples.push_back(run.samples[i]);
  }
  const Result result = smooth(samples, SurveyRun::config());
  EXPECT_EQ(std::count_if(result.verdicts.begin(), result.verdicts.end(),
                          [](const Verdict& v) { return v.kind == VerdictKind::out_of_range; }),
            8);
  ASSERT_EQ(result.smoothed.size(), plain.smoothed.size());
  EXPECT_EQ(result.smoothed.front().header.stamp_ns, plain.smoothed.front().header.stamp_ns);
  EXPECT_EQ(result.smoothed.back().latitude_rad, plain.smoothed.back().latitude_rad);
  EXPECT_TRUE(known(result.smoothed.back().latitude_rad));
}

TEST(Smoother, TellsOfEachOrderWhatBecameOfIt) {
  const SurveyRun run({.duration_s = 20.0, .dive_s = 1e9});
  Smoother smoother(SurveyRun::config());
  for (const test::Sample& sample : run.samples) std::visit([&](const auto& s) { smoother.add(s); }, sample);
  Command rest;
  rest.kind = CommandKind::mark_at_rest;
  rest.value_s = 1.0;
  for (const double t_s : {-5.0, 5.0, 1e6}) {
    rest.header.stamp_ns = SurveyRun::kEpochNs + from_seconds(t_s);
    EXPECT_EQ(smoother.add(rest), "");
  }
  rest.header.stamp_ns = std::numeric_limits<TimeNs>::max();
  EXPECT_NE(smoother.add(rest), "");
  Command wrong;
  wrong.header.stamp_ns = SurveyRun::kEpochNs + 6 * kNsPerSecond;
  wrong.kind = CommandKind::set_position;
  EXPECT_NE(smoother.add(wrong), "");  // where to?
  wrong.kind = CommandKind::disable_source;
  wrong.target = "nobody";
  EXPECT_NE(smoother.add(wrong), "");
  std::vector<OrderFate> fates;
  Smoother::Output output;
  output.outcome = [&](const OrderOutcome& outcome) { fates.push_back(outcome.fate); };
  smoother.run(output);
  EXPECT_EQ(fates, (std::vector<OrderFate>{OrderFate::not_done, OrderFate::done, OrderFate::not_done}));
}

TEST(Smoother, DoesNotSmearAPositionThatWasOrdered) {
  // Under way without fixes, the operator moves the vehicle by 300 m north on the map, wrongly: what is
  // before the order must not hear of it, what is behind it must.
  const SurveyRun run([] {
    SurveyRun::Options options = outage_in_the_middle(6);
    options.surface_s = 1e9;
    options.duration_s = 110.0;
    return options;
  }());
  constexpr double kOrder_s = 80.0;
  const auto at = static_cast<std::size_t>(kOrder_s * 100.0);
  const auto order = [&](Smoother& smoother, const test::Sample& sample) {
    if (!std::holds_alternative<ImuSample>(sample) ||
        test::header(sample).stamp_ns != SurveyRun::kEpochNs + from_seconds(kOrder_s))
      return;
    Command command;
    command.header.stamp_ns = test::header(sample).stamp_ns + 1;
    command.kind = CommandKind::set_position;
    command.latitude_rad = run.truth[at].latitude_rad + 300.0 / 6.36e6;
    command.longitude_rad = run.truth[at].longitude_rad;
    command.sigma_m = 1.0;
    EXPECT_EQ(smoother.add(command), "");
    command.header.stamp_ns += 1;
    command.confirmed = true;
    EXPECT_EQ(smoother.add(command), "");
  };
  const Result plain = smooth(run.samples, SurveyRun::config());
  const Result result = smooth(run.samples, SurveyRun::config(), order);
  const auto north_m = [&](const Result& of, std::size_t i) {
    return (of.smoothed[i].latitude_rad - run.truth[i].latitude_rad) * 6.36e6;
  };
  EXPECT_NEAR(north_m(result, at - 1), north_m(plain, at - 1), 0.5);
  EXPECT_NEAR(north_m(result, at), north_m(plain, at), 0.5);
  EXPECT_NEAR(north_m(result, at + 1), 300.0, 3.0);
  EXPECT_NEAR(result.smoothed[at + 1].position_covariance_N_m2[0], 1.0, 0.5);
  EXPECT_NEAR(north_m(result, at + 2000), 300.0, 10.0);
}

TEST(Smoother, DoesNotReachBackThroughANewStart) {
  SurveyRun::Options options = outage_in_the_middle(7);
  options.duration_s = 60.0;
  options.dive_s = 1e9;
  const SurveyRun run(options);
  const auto realign = [&](Smoother& smoother, const test::Sample& sample) {
    if (!std::holds_alternative<ImuSample>(sample) ||
        test::header(sample).stamp_ns != SurveyRun::kEpochNs + 40 * kNsPerSecond)
      return;
    Command command;
    command.header.stamp_ns = test::header(sample).stamp_ns + 1;
    command.kind = CommandKind::realign;
    EXPECT_EQ(smoother.add(command), "");
  };
  std::vector<test::Sample> first;
  std::copy_if(run.samples.begin(), run.samples.end(), std::back_inserter(first), [](const test::Sample& s) {
    return test::header(s).stamp_ns <= SurveyRun::kEpochNs + 40 * kNsPerSecond;
  });
  const Result whole = smooth(run.samples, SurveyRun::config(), realign);
  const Result half = smooth(first, SurveyRun::config());
  ASSERT_GT(whole.smoothed.size(), half.smoothed.size());
  bool navigating = false;
  for (std::size_t i = 0; i < half.smoothed.size(); ++i) {
    navigating = navigating || known(half.smoothed[i].latitude_rad);
    if (!known(half.smoothed[i].latitude_rad)) continue;
    ASSERT_NEAR(whole.smoothed[i].latitude_rad, half.smoothed[i].latitude_rad, 1e-13) << i;
  }
  EXPECT_TRUE(navigating);
  EXPECT_FALSE(known(whole.smoothed[half.smoothed.size() + 5].latitude_rad));
  EXPECT_TRUE(known(whole.smoothed.back().latitude_rad));
}

}  // namespace
}  // namespace fathom::estimation
