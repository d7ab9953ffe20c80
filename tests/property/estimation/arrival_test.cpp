// Whatever the order in which measurements arrive, the state and the final verdicts are the same: with random
// data, outliers that flip gates, samples sent twice, stamps used twice, orders, and more measurements than
// there is room for.

#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <tuple>

#include <gtest/gtest.h>

#include "same_bits.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

/// Twelve seconds of a vehicle that moves steadily and knows its place to 50 m.
struct Trial {
  static constexpr int kSteps = 120;
  static constexpr double kStep_s = 0.1;
  static constexpr geo::Geodetic kStart{0.6, 0.2, -20.0};

  explicit Trial(std::uint64_t seed) : normal(seed) {
    const Eigen::Vector3d v_N(1.5, 0.4, 0.05);
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
      const geo::Geodetic at = geo::moved_by(kStart, t * v_N + normal.vector(1.0) + wrong(0.15, 200.0));
      if (k % 5 == 2) {
        GpsSample gps;
        gps.header = header("gps0", k, offset_ns());
        gps.fix = GpsFix::fix_3d;
        gps.latitude_rad = at.latitude_rad;
        gps.longitude_rad = at.longitude_rad;
        gps.altitude_m = at.altitude_m;
        gps.velocity_N_m_s = geo::arr(v_N + normal.vector(0.05) + wrong(0.05, 3.0));
        take(gps);
      }
      if (k % 2 == 0) {
        DvlSample dvl;
        dvl.header = header("dvl0", k, offset_ns());
        dvl.velocity_D_m_s = geo::arr(c.transpose() * v_N + normal.vector(0.01) + wrong(0.1, 0.3));
        take(dvl);
      }
      if (k % 5 == 0) {
        for (const char* gauge : {"depth0", "depth1"}) {
          DepthSample depth;
          depth.header = header(gauge, k, offset_ns());
          depth.depth_m = 20.0 + 0.05 * t + normal(0.03) + wrong(0.1, 2.0).x();
          take(depth);
        }
        HeadingSample heading;
        heading.header = header("compass0", k, offset_ns());
        heading.heading_rad = 0.26 + normal(0.01) + wrong(0.1, 0.3).x();
        take(heading);
      }
      if (k % 20 == 12) {
        UsblSample usbl;
        usbl.header = header("usbl0", k, offset_ns());
        usbl.latitude_rad = at.latitude_rad;
        usbl.longitude_rad = at.longitude_rad;
        usbl.depth_m = 20.0;
        usbl.sigma_m = 2.0;
        take(usbl);
      }
    }
    const int off = static_cast<int>(normal.uniform(20.0, 60.0));
    order(off, CommandKind::disable_source, normal.uniform(0.0, 1.0) < 0.5 ? "dvl0" : "gps0");
    order(off + 25, CommandKind::enable_source, orders.back().target);
    Command place;
    place.latitude_rad = kStart.latitude_rad + normal(5e-6);
    place.longitude_rad = kStart.longitude_rad + normal(5e-6);
    place.sigma_m = 20.0;
    const int set = static_cast<int>(normal.uniform(10.0, 110.0));
    order(set, CommandKind::set_position, {}, place);
    // Of one instant, with the same number, by somebody else.
    orders.push_back(orders.back());
    orders.back().header.sensor = "console:anna";
    orders.back().latitude_rad += 1e-6;
  }

  /// Mostly nothing, now and then an error of such a size.
  Eigen::Vector3d wrong(double probability, double sigma) {
    return normal.uniform(0.0, 1.0) < probability ? normal.vector(sigma) : Eigen::Vector3d(0.0, 0.0, 0.0);
  }
  /// At the instant of an inertial sample, where instruments meet, or somewhere behind it.
  TimeNs offset_ns() {
    return normal.uniform(0.0, 1.0) < 0.5 ? 0 : static_cast<TimeNs>(normal.uniform(0.0, 9e7));
  }
  template <class Sample>
  void take(Sample sample) {
    aiding.emplace_back(sample);
    const double what = normal.uniform(0.0, 1.0);
    if (what < 0.05) {
      aiding.emplace_back(sample);  // sent twice
    } else if (what < 0.1) {
      ++sample.header.sequence;  // its number is free: they grow by two
      spoil(sample);
      aiding.emplace_back(sample);  // another one of the same stamp: the first number counts
    }
  }
  static void spoil(GpsSample& sample) { sample.latitude_rad += 2e-6; }
  static void spoil(DvlSample& sample) { sample.velocity_D_m_s[0] += 0.02; }
  static void spoil(DepthSample& sample) { sample.depth_m += 0.05; }
  static void spoil(HeadingSample& sample) { sample.heading_rad += 0.01; }
  static void spoil(UsblSample& sample) { sample.latitude_rad += 2e-6; }
  void order(int step, CommandKind kind, const Name& target, Command command = {}) {
    command.header = header("operator", step, offset_ns());
    command.header.sequence = orders.size() + 1;
    command.kind = kind;
    command.target = target;
    orders.push_back(command);
  }
  static SampleHeader header(const char* sensor, int step, TimeNs offset_ns) {
    SampleHeader out;
    out.vehicle = "auv";
    out.sensor = sensor;
    out.stamp_ns = SurveyRun::kEpochNs + step * from_seconds(kStep_s) + offset_ns;
    out.received_ns = out.stamp_ns;
    out.sequence = static_cast<std::uint64_t>(2 * step + 1);
    return out;
  }
  static EngineConfig config(std::uint32_t replay_steps) {
    EngineConfig c;
    c.imu.nominal_rate_hz = 1.0 / kStep_s;
    c.horizon_s = 8.0;
    c.snapshot_interval_s = 0.5;
    c.measurement_capacity = 64;  // some five seconds of them
    c.replay_steps_per_sample = replay_steps;
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
    s.position_sigma_N_m = {50.0, 50.0, 10.0};
    return s;
  }
  /// Behind which inertial sample each measurement and order arrives: up to four before its own, as clocks
  /// that disagree make it, or late.
  struct Arrivals {
    std::vector<int> aiding;
    std::vector<int> orders;
  };
  Arrivals arrivals(test::Normal& random, double earliest_s, double latest_s) const {
    const auto arrival = [&](const SampleHeader& one) {
      const double own = to_seconds(one.stamp_ns - SurveyRun::kEpochNs) / kStep_s;
      const double step = own + random.uniform(earliest_s, latest_s) / kStep_s;
      return static_cast<int>(std::clamp(std::floor(step), 0.0, kSteps - 1.0));
    };
    Arrivals out;
    for (const test::Sample& sample : aiding) out.aiding.push_back(arrival(test::header(sample)));
    for (const Command& one : orders) out.orders.push_back(arrival(one.header));
    return out;
  }

  test::Normal normal;
  std::vector<ImuSample> imu;
  std::vector<test::Sample> aiding;
  std::vector<Command> orders;
};

/// Everything that a final verdict says of the judgement.
using Final =
    std::tuple<SourceKind, std::string, TimeNs, std::uint64_t, VerdictKind, std::string, std::uint64_t>;

Final final_of(const Verdict& verdict) {
  std::uint64_t numbers = 0;
  const auto mix = [&](double number) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    numbers = (numbers ^ bits) * 0x100000001B3ULL;
  };
  for (std::size_t i = 0; i < verdict.dimensions; ++i) {
    mix(verdict.innovation[i]);
    mix(verdict.innovation_sigma[i]);
  }
  mix(verdict.test_ratio);
  mix(verdict.limit);
  return {verdict.source,
          verdict.header.sensor.str(),
          verdict.header.stamp_ns,
          verdict.header.sequence,
          verdict.kind,
          verdict.model.str(),
          numbers};
}

/// One engine on its way through a trial.
struct Passage {
  explicit Passage(FusionEngine& the_engine) : engine(the_engine) {
    engine.start_from(Trial::start());
    for (Verdict verdict; engine.next_verdict(verdict);) continue;
  }
  void step(const Trial& trial, int k, const Trial::Arrivals& after, const std::vector<std::size_t>& order) {
    engine.add(trial.imu[static_cast<std::size_t>(k)]);
    for (std::size_t i = 0; i < trial.orders.size(); ++i) {
      if (after.orders[i] != k) continue;
      EXPECT_EQ(engine.apply(trial.orders[i]), "");
    }
    for (const std::size_t i : order)
      if (after.aiding[i] == k) test::feed(engine, trial.aiding[i]);
    take();
  }
  void take() {
    for (Verdict verdict; engine.next_verdict(verdict);) {
      firsts += verdict.revision == 0 ? 1U : 0U;
      revised += verdict.revision > 0 && is_news(verdict) ? 1U : 0U;
      if (!verdict.is_final) continue;
      finals.push_back(final_of(verdict));
      ++kinds[verdict.kind];
      const DurationNs held = engine.nav_state().header.stamp_ns - verdict.header.stamp_ns;
      if (verdict.revision > 0 && held < from_seconds(7.5)) ++early;
    }
  }
  void finish() {
    engine.finish();
    early_before_finish = early;
    take();
    std::sort(finals.begin(), finals.end());
  }

  FusionEngine& engine;
  std::vector<Final> finals;
  std::size_t firsts = 0;
  std::size_t revised = 0;
  std::size_t early = 0;                ///< final before the horizon was over: there was no room
  std::size_t early_before_finish = 0;  ///< of them
  std::map<VerdictKind, std::size_t> kinds;
};

void expect_same_state(const FusionEngine& a, const FusionEngine& b) {
  const NavState& one = a.nav_state();
  const NavState& other = b.nav_state();
  ASSERT_EQ(one.mode, other.mode);
  ASSERT_EQ(one.reset_counter, other.reset_counter);
  ASSERT_EQ(one.latitude_rad, other.latitude_rad);
  ASSERT_EQ(one.longitude_rad, other.longitude_rad);
  ASSERT_EQ(one.altitude_m, other.altitude_m);
  ASSERT_TRUE(same_bits(one.velocity_N_m_s, other.velocity_N_m_s));
  ASSERT_TRUE(same_bits(one.q_NB, other.q_NB));
  ASSERT_TRUE(same_bits(one.position_covariance_N_m2, other.position_covariance_N_m2));
  ASSERT_TRUE(same_bits(one.velocity_covariance_N_m2_s2, other.velocity_covariance_N_m2_s2));
  NavDetail details;
  NavDetail others;
  a.fill(details);
  b.fill(others);
  ASSERT_EQ(details.count, others.count);
  for (std::uint32_t i = 0; i < details.count; ++i) {
    ASSERT_EQ(details.states[i].value, others.states[i].value) << i;
    ASSERT_EQ(details.states[i].sigma, others.states[i].sigma) << i;
  }
}

void shuffle(std::vector<std::size_t>& order, test::Normal& random) {
  for (std::size_t i = 0; i < order.size(); ++i)
    std::swap(order[i], order[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i) + 0.999))]);
}

std::vector<std::size_t> in_order(const Trial& trial) {
  std::vector<std::size_t> out(trial.aiding.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

constexpr std::uint32_t kAll = 100'000;

TEST(Arrival, ChangesNeitherStateNorFinalVerdicts) {
  FusionEngine punctual(Trial::config(kAll));
  FusionEngine engine(Trial::config(kAll));
  std::map<VerdictKind, std::size_t> kinds;
  std::size_t revised = 0;
  std::size_t early = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const Trial trial(seed);
    ASSERT_GT(trial.aiding.size(), 2U * 64U);
    auto order = in_order(trial);
    test::Normal random(1000 + seed);
    Passage expected(punctual);
    const auto own = trial.arrivals(random, 0.0, 0.0);
    for (int k = 0; k <= Trial::kSteps; ++k) expected.step(trial, k, own, order);
    for (int permutation = 0; permutation < 12; ++permutation) {
      SCOPED_TRACE(permutation);
      const auto after = trial.arrivals(random, -0.4, permutation % 2 == 0 ? 2.0 : 0.5);
      shuffle(order, random);
      Passage passage(engine);
      for (int k = 0; k <= Trial::kSteps; ++k) passage.step(trial, k, after, order);
      ASSERT_NO_FATAL_FAILURE(expect_same_state(engine, punctual));
      passage.finish();
      ASSERT_EQ(passage.finals.size(), trial.aiding.size());
      ASSERT_EQ(passage.firsts, trial.aiding.size());
      if (permutation == 0) expected.finish();
      ASSERT_EQ(passage.finals, expected.finals);
      revised += passage.revised;
      early += passage.early_before_finish;
    }
    for (const auto& [kind, count] : expected.kinds) kinds[kind] += count;
  }
  // Everything that the trials are for has happened.
  EXPECT_GT(revised, 1000U);
  EXPECT_GT(early, 1000U);
  EXPECT_GT(kinds[VerdictKind::used], 5000U);
  EXPECT_GT(kinds[VerdictKind::rejected], 500U);
  EXPECT_GT(kinds[VerdictKind::duplicate], 500U);
  EXPECT_GT(kinds[VerdictKind::source_disabled], 200U);
  EXPECT_EQ(kinds[VerdictKind::late], 0U);
  RecordProperty("revised", static_cast<int>(revised));
}

TEST(Arrival, SpreadOverSamplesTheStateIsTheSameWheneverNothingIsBeingMadeUpFor) {
  FusionEngine whole(Trial::config(kAll));
  FusionEngine spread(Trial::config(3));
  std::size_t apart = 0;
  std::size_t equal = 0;
  std::size_t revised = 0;
  int longest = 0;
  for (std::uint64_t seed = 101; seed <= 140; ++seed) {
    SCOPED_TRACE(seed);
    const Trial trial(seed);
    auto order = in_order(trial);
    test::Normal random(2000 + seed);
    for (int permutation = 0; permutation < 6; ++permutation) {
      SCOPED_TRACE(permutation);
      // From few late ones, with pauses in between, to a flood of them.
      auto after = trial.arrivals(random, 0.0, 0.0);
      const auto late = trial.arrivals(random, -0.4, 1.0);
      for (std::size_t i = 0; i < after.aiding.size(); ++i)
        if (random.uniform(0.0, 5.0) < permutation) after.aiding[i] = late.aiding[i];
      for (std::size_t i = 0; i < after.orders.size(); ++i)
        if (random.uniform(0.0, 5.0) < permutation) after.orders[i] = late.orders[i];
      shuffle(order, random);
      Passage expected(whole);
      Passage passage(spread);
      int behind = 0;
      for (int k = 0; k <= Trial::kSteps; ++k) {
        expected.step(trial, k, after, order);
        passage.step(trial, k, after, order);
        ASSERT_FALSE(whole.catching_up());
        if (spread.catching_up()) {
          longest = std::max(longest, ++behind);
          ++apart;
        } else {
          behind = 0;
          ++equal;
          ASSERT_NO_FATAL_FAILURE(expect_same_state(spread, whole)) << k;
        }
      }
      expected.finish();
      passage.finish();
      ASSERT_NO_FATAL_FAILURE(expect_same_state(spread, whole));
      ASSERT_EQ(passage.finals, expected.finals);
      ASSERT_EQ(passage.firsts, trial.aiding.size());
      revised += passage.revised;
    }
  }
  EXPECT_GT(apart, 1000U);
  EXPECT_GT(equal, 1000U);
  EXPECT_GT(revised, 500U);
  EXPECT_LE(longest, 32);
}

}  // namespace
}  // namespace fathom::estimation
