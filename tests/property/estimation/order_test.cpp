#include <numeric>

#include <gtest/gtest.h>

#include "same_bits.hpp"
#include "support/vehicles/survey_run.hpp"

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
  EngineConfig config = SurveyRun::config();
  // What comes with the inertial steps must be repeated by a roll-back as well.
  config.constraints.non_holonomic.enabled = config.constraints.constant_depth.enabled = true;
  config.constraints.non_holonomic.lateral_sigma_m_s = config.constraints.non_holonomic.vertical_sigma_m_s =
      0.5;
  FusionEngine engine(config);
  for (const test::Sample& sample : samples)
    if (std::holds_alternative<ImuSample>(sample) || test::header(sample).stamp_ns < until)
      test::feed(engine, sample);
  engine.finish();  // the last one may still be made up for
  engine.fill(detail);
  return engine.nav_state();
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

/// Three and a half seconds of a vehicle that moves steadily, and what aids it: seven instruments, two of
/// them of one kind, often at the same instant.
struct ShortRun {
  static constexpr int kSteps = 35;
  static constexpr double kStep_s = 0.1;
  static constexpr geo::Geodetic kStart{0.6, 0.2, -20.0};

  ShortRun() {
    const Eigen::Vector3d v_N(1.5, 0.4, 0.05);
    test::Normal normal(17);
    const geo::LocalEarth earth(kStart);
    const Eigen::Matrix3d c = geo::to_matrix(geo::from_rpy({0.02, -0.03, 0.26}));
    const Eigen::Vector3d rate_B =
        c.transpose() * (earth.earth_rate_N + earth.transport_rate_N(v_N)) + Eigen::Vector3d(0.0, 0.0, 1e-4);
    const Eigen::Vector3d force_B = c.transpose() * Eigen::Vector3d(0.0, 0.0, -earth.gravity_m_s2);
    for (int k = 0; k <= kSteps; ++k) {
      ImuSample sample;
      sample.header = header("imu", k, 0);
      sample.angular_rate_B_rad_s = geo::arr(rate_B + normal.vector(1e-4));
      sample.specific_force_B_m_s2 = geo::arr(force_B + normal.vector(1e-3));
      imu.push_back(sample);
    }
    for (int k = 1; k < kSteps; ++k) {
      const double t = k * kStep_s;
      const geo::Geodetic at = geo::moved_by(kStart, t * v_N + normal.vector(1.0));
      if (k % 10 == 5) {
        GpsSample gps;
        gps.header = header("gps0", k, k % 20 == 5 ? 0 : 30'000'000);
        gps.fix = GpsFix::fix_3d;
        gps.latitude_rad = at.latitude_rad;
        gps.longitude_rad = at.longitude_rad;
        gps.altitude_m = at.altitude_m;
        gps.velocity_N_m_s = geo::arr(v_N + normal.vector(0.05));
        aiding.emplace_back(gps);
      }
      if (k % 5 == 0) {
        DvlSample dvl;
        dvl.header = header("dvl0", k, k % 10 == 0 ? 0 : 55'000'000);
        dvl.velocity_D_m_s = geo::arr(c.transpose() * v_N + normal.vector(0.01));
        aiding.emplace_back(dvl);
      }
      if (k % 10 == 5) {
        for (const char* gauge : {"depth0", "depth1"}) {
          DepthSample depth;
          depth.header = header(gauge, k, 0);
          depth.depth_m = 20.0 + 0.05 * t + normal(0.03);
          aiding.emplace_back(depth);
        }
        HeadingSample heading;
        heading.header = header("compass0", k, 0);
        heading.heading_rad = 0.26 + normal(0.01);
        aiding.emplace_back(heading);
      }
      if (k == 12) {
        UsblSample usbl;
        usbl.header = header("usbl0", k, 13'000'000);
        usbl.latitude_rad = at.latitude_rad;
        usbl.longitude_rad = at.longitude_rad;
        usbl.depth_m = 20.0;
        usbl.sigma_m = 2.0;
        aiding.emplace_back(usbl);
      }
    }
  }

  static SampleHeader header(const char* sensor, int step, TimeNs offset_ns) {
    SampleHeader out;
    out.vehicle = "auv";
    out.sensor = sensor;
    out.stamp_ns = SurveyRun::kEpochNs + step * from_seconds(kStep_s) + offset_ns;
    out.received_ns = out.stamp_ns;
    out.sequence = static_cast<std::uint64_t>(step + 1);
    return out;
  }
  static EngineConfig config() {
    EngineConfig c;
    c.imu.nominal_rate_hz = 1.0 / kStep_s;
    c.snapshot_interval_s = 0.5;
    c.measurement_capacity = 64;
    c.states.surface_altitude_sigma_m = 1.0;
    c.sensors = {default_sensor(SourceKind::gps, "gps0"),         default_sensor(SourceKind::dvl, "dvl0"),
                 default_sensor(SourceKind::depth, "depth0"),     default_sensor(SourceKind::depth, "depth1"),
                 default_sensor(SourceKind::heading, "compass0"), default_sensor(SourceKind::usbl, "usbl0")};
    return c;
  }
  static InitialState start() {
    InitialState s;
    s.latitude_rad = kStart.latitude_rad;
    s.longitude_rad = kStart.longitude_rad;
    s.altitude_m = kStart.altitude_m;
    s.velocity_N_m_s = {1.5, 0.4, 0.05};
    s.rpy_rad = {0.02, -0.03, 0.26};
    return s;
  }

  std::vector<ImuSample> imu;
  std::vector<test::Sample> aiding;
};

/// All numbers that tell a state apart, and the number of measurements judged.
struct Ending {
  NavState nav;
  NavDetail detail;
  std::size_t verdicts = 0;
  std::size_t used = 0;
};

/// `after[i]`: aiding sample i arrives behind this inertial sample; `order`: who comes first of those behind
/// one.
Ending end_of(FusionEngine& engine, const ShortRun& run, const std::vector<int>& after,
              const std::vector<std::size_t>& order, bool finish = false) {
  Ending out;
  engine.start_from(ShortRun::start());
  Verdict verdict;
  const auto take = [&] {
    while (engine.next_verdict(verdict)) {
      if (verdict.revision > 0) continue;
      ++out.verdicts;
      out.used += verdict.kind == VerdictKind::used ? 1 : 0;
    }
  };
  while (engine.next_verdict(verdict)) {
  }
  for (int k = 0; k <= ShortRun::kSteps; ++k) {
    engine.add(run.imu[static_cast<std::size_t>(k)]);
    for (const std::size_t i : order)
      if (after[i] == k) test::feed(engine, run.aiding[i]);
    take();
  }
  if (finish) engine.finish();
  take();
  out.nav = engine.nav_state();
  engine.fill(out.detail);
  return out;
}

/// The step at which each measurement is due by its own stamp.
std::vector<int> own_steps(const ShortRun& run) {
  std::vector<int> out;
  for (const test::Sample& sample : run.aiding)
    out.push_back(static_cast<int>((test::header(sample).stamp_ns - SurveyRun::kEpochNs) /
                                   from_seconds(ShortRun::kStep_s)));
  return out;
}

TEST(Order, TenThousandPermutationsGiveTheSameBits) {
  const ShortRun run;
  FusionEngine engine(ShortRun::config());
  const std::size_t count = run.aiding.size();
  std::vector<int> after = own_steps(run);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::vector<int> earliest = after;
  const Ending expected = end_of(engine, run, after, order);
  ASSERT_EQ(expected.verdicts, count);
  ASSERT_EQ(expected.used, count);
  test::Normal random(2024);
  int late_usbl = 0;
  for (int trial = 0; trial < 10'000; ++trial) {
    for (std::size_t i = 0; i < count; ++i) {
      // Up to four steps before its own instant, as clocks that disagree make it, or any time later.
      const int first = std::max(0, earliest[i] - 4);
      const double last =
          trial % 2 == 0 ? ShortRun::kSteps - 0.001 : std::min(ShortRun::kSteps - 0.001, earliest[i] + 4.0);
      after[i] = static_cast<int>(random.uniform(first, last));
      std::swap(order[i],
                order[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i) + 0.999))]);
      if (std::holds_alternative<UsblSample>(run.aiding[i]) && after[i] >= earliest[i] + 20) ++late_usbl;
    }
    const Ending ending = end_of(engine, run, after, order);
    ASSERT_EQ(ending.verdicts, count) << trial;
    ASSERT_EQ(ending.nav.latitude_rad, expected.nav.latitude_rad) << trial;
    ASSERT_EQ(ending.nav.longitude_rad, expected.nav.longitude_rad) << trial;
    ASSERT_EQ(ending.nav.altitude_m, expected.nav.altitude_m) << trial;
    ASSERT_TRUE(same_bits(ending.nav.velocity_N_m_s, expected.nav.velocity_N_m_s)) << trial;
    ASSERT_TRUE(same_bits(ending.nav.q_NB, expected.nav.q_NB)) << trial;
    ASSERT_TRUE(same_bits(ending.nav.position_covariance_N_m2, expected.nav.position_covariance_N_m2))
        << trial;
    ASSERT_TRUE(same_bits(ending.nav.velocity_covariance_N_m2_s2, expected.nav.velocity_covariance_N_m2_s2));
    ASSERT_TRUE(same_bits(ending.nav.rpy_sigma_rad, expected.nav.rpy_sigma_rad)) << trial;
    for (std::uint32_t i = 0; i < expected.detail.count; ++i) {
      ASSERT_EQ(ending.detail.states[i].value, expected.detail.states[i].value) << trial << ' ' << i;
      ASSERT_EQ(ending.detail.states[i].sigma, expected.detail.states[i].sigma) << trial << ' ' << i;
    }
  }
  EXPECT_GT(late_usbl, 500);  // two seconds late or more
}

TEST(Order, SpreadOverSamplesItGivesTheSameBits) {
  // Three steps a sample: late measurements meet navigators that are still catching up, in front of them and
  // behind them.
  const ShortRun run;
  FusionEngine engine(ShortRun::config());
  EngineConfig slow = ShortRun::config();
  slow.replay_steps_per_sample = 3;
  FusionEngine spread(slow);
  const std::size_t count = run.aiding.size();
  std::vector<int> after = own_steps(run);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::vector<int> earliest = after;
  const Ending expected = end_of(engine, run, after, order);
  test::Normal random(2025);
  for (int trial = 0; trial < 2'000; ++trial) {
    for (std::size_t i = 0; i < count; ++i) {
      const int first = std::max(0, earliest[i] - 4);
      const double last =
          trial % 2 == 0 ? ShortRun::kSteps - 0.001 : std::min(ShortRun::kSteps - 0.001, earliest[i] + 12.0);
      after[i] = static_cast<int>(random.uniform(first, last));
      std::swap(order[i],
                order[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i) + 0.999))]);
    }
    const Ending ending = end_of(spread, run, after, order, true);
    ASSERT_EQ(ending.verdicts, count) << trial;
    ASSERT_EQ(ending.nav.latitude_rad, expected.nav.latitude_rad) << trial;
    ASSERT_TRUE(same_bits(ending.nav.velocity_N_m_s, expected.nav.velocity_N_m_s)) << trial;
    ASSERT_TRUE(same_bits(ending.nav.q_NB, expected.nav.q_NB)) << trial;
    ASSERT_TRUE(same_bits(ending.nav.position_covariance_N_m2, expected.nav.position_covariance_N_m2))
        << trial;
    for (std::uint32_t i = 0; i < expected.detail.count; ++i)
      ASSERT_EQ(ending.detail.states[i].value, expected.detail.states[i].value) << trial << ' ' << i;
  }
}

TEST(Order, NoSampleRepeatsMoreThanItMay) {
  const SurveyRun run({.duration_s = 60.0, .dive_s = 20.0});
  EngineConfig config = SurveyRun::config();
  config.replay_steps_per_sample = 40;
  FusionEngine spread(config);
  config.replay_steps_per_sample = 1000;
  FusionEngine whole(config);
  std::uint64_t most = 0;
  int apart = 0;
  for (const test::Sample& sample : run.samples) {
    const std::uint64_t before = spread.repeated_steps();
    test::feed(spread, sample);
    test::feed(whole, sample);
    most = std::max(most, spread.repeated_steps() - before);
    const double t = to_seconds(test::header(sample).received_ns - SurveyRun::kEpochNs);
    if (whole.nav_state().mode < NavMode::gps_aided) continue;
    const bool equal = spread.nav_state().latitude_rad == whole.nav_state().latitude_rad;
    if (!equal) ++apart;
    // A fix of 2 s ago needs some 220 steps: six samples, and as many again where a second one interferes.
    const double since_fix = std::fmod(t - 2.5 - 2.0, 5.0);
    if (since_fix > 0.2) {
      ASSERT_TRUE(equal) << t;
    }
  }
  EXPECT_LE(most, 2U * 40U);
  EXPECT_GT(apart, 0);
}

TEST(Order, EveryMeasurementHasItsVerdictAtTheEnd) {
  const ShortRun run;
  FusionEngine engine(ShortRun::config());
  engine.start_from(ShortRun::start());
  for (const ImuSample& sample : run.imu) engine.add(sample);
  // None of them has met an inertial sample after it.
  for (const test::Sample& sample : run.aiding) test::feed(engine, sample);
  DepthSample ahead;
  ahead.header = ShortRun::header("depth0", ShortRun::kSteps, 40'000'000);
  ahead.depth_m = 20.0;
  engine.add(ahead);
  Verdict verdict;
  EXPECT_FALSE(engine.next_verdict(verdict));
  engine.finish();
  std::array<std::size_t, kVerdictKinds> kinds{};
  while (engine.next_verdict(verdict))
    if (verdict.is_final) ++kinds[static_cast<std::size_t>(verdict.kind)];
  EXPECT_EQ(kinds[static_cast<std::size_t>(VerdictKind::used)], run.aiding.size());
  EXPECT_EQ(kinds[static_cast<std::size_t>(VerdictKind::from_the_future)], 1U);
  // And they have acted: the same as if each had come in time.
  FusionEngine punctual(ShortRun::config());
  std::vector<int> after;
  std::vector<std::size_t> order;
  for (const test::Sample& sample : run.aiding) {
    after.push_back(static_cast<int>((test::header(sample).stamp_ns - SurveyRun::kEpochNs) /
                                     from_seconds(ShortRun::kStep_s)));
    order.push_back(order.size());
  }
  const Ending expected = end_of(punctual, run, after, order);
  EXPECT_EQ(engine.nav_state().latitude_rad, expected.nav.latitude_rad);
  EXPECT_TRUE(same_bits(engine.nav_state().velocity_N_m_s, expected.nav.velocity_N_m_s));
  engine.finish();
  EXPECT_FALSE(engine.next_verdict(verdict));
}

TEST(Order, ALateFixRepeatsLittleMoreThanItsDelay) {
  const SurveyRun run({.duration_s = 40.0, .dive_s = 30.0, .usbl = false});
  FusionEngine engine(SurveyRun::config());
  for (const test::Sample& sample : run.samples) test::feed(engine, sample);
  const NavState& nav = engine.nav_state();
  const std::uint64_t before = engine.repeated_steps();
  // What a tenth of a second of delay costs all along: measurements late by 0.05 to 0.2 s, 27 a second.
  EXPECT_LT(static_cast<double>(before), 3.0 * static_cast<double>(run.truth.size()));
  UsblSample usbl;
  usbl.header.sensor = "usbl0";
  usbl.header.stamp_ns = nav.header.stamp_ns - from_seconds(2.0);
  usbl.header.sequence = 1;
  usbl.latitude_rad = nav.latitude_rad;
  usbl.longitude_rad = nav.longitude_rad;
  usbl.depth_m = nav.depth_m;
  usbl.sigma_m = 2.0;
  engine.add(usbl);
  engine.finish();
  const std::uint64_t repeated = engine.repeated_steps() - before;
  EXPECT_GE(repeated, 200U);
  EXPECT_LE(repeated, 200U + 21U);
}

}  // namespace
}  // namespace fathom::estimation
