// What is said of a measurement agrees with what the state does, also when a late neighbour changes it.

#include <cstddef>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

constexpr TimeNs kEpochNs = test::SurveyRun::kEpochNs;
constexpr geo::Geodetic kStart{0.6, 0.2, 0.0};
constexpr double kStep_s = 0.1;

/// A vehicle that lies still, at a place of which it knows 200 m.
class Adrift {
 public:
  explicit Adrift(const std::function<void(EngineConfig&)>& change = {}) : engine(config(change)) {
    InitialState start;
    start.latitude_rad = kStart.latitude_rad;
    start.longitude_rad = kStart.longitude_rad;
    start.position_sigma_N_m = {200.0, 200.0, 200.0};
    engine.start_from(start);
  }

  static EngineConfig config(const std::function<void(EngineConfig&)>& change) {
    EngineConfig c;
    c.imu.nominal_rate_hz = 1.0 / kStep_s;
    c.horizon_s = 2.0;
    c.measurement_capacity = 64;
    c.sensors = {default_sensor(SourceKind::gps, "gps0")};
    if (change) change(c);
    return c;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) {
      ImuSample sample;
      sample.header = header("imu", ++steps_);
      const geo::LocalEarth earth(kStart);
      sample.angular_rate_B_rad_s = geo::arr(earth.earth_rate_N);
      sample.specific_force_B_m_s2 = {0.0, 0.0, -earth.gravity_m_s2};
      ASSERT_TRUE(engine.add(sample));
      take();
    }
  }
  /// A fix stamped with the given inertial sample, so far north of where the vehicle is.
  void fix(int step, double north_m) {
    GpsSample sample;
    sample.header = header("gps0", step);
    sample.fix = GpsFix::fix_3d;
    const geo::Geodetic at = geo::moved_by(kStart, {north_m, 0.0, 0.0});
    sample.latitude_rad = at.latitude_rad;
    sample.longitude_rad = at.longitude_rad;
    sample.altitude_m = at.altitude_m;
    sample.position_sigma_N_m = {2.0, 2.0, 2.0};
    engine.add(sample, "receiver");
    take();
  }
  void take() {
    for (Verdict verdict; engine.next_verdict(verdict);) verdicts.push_back(verdict);
  }
  [[nodiscard]] std::vector<Verdict> of(int step) const {
    std::vector<Verdict> out;
    for (const Verdict& one : verdicts)
      if (one.header.sequence == static_cast<std::uint64_t>(step)) out.push_back(one);
    return out;
  }
  [[nodiscard]] double north_m() const {
    const NavState& nav = engine.nav_state();
    return geo::difference_N(kStart, {nav.latitude_rad, nav.longitude_rad, nav.altitude_m}).x();
  }
  [[nodiscard]] static SampleHeader header(const char* sensor, int step) {
    SampleHeader out;
    out.vehicle = "auv";
    out.sensor = sensor;
    out.stamp_ns = out.received_ns = kEpochNs + step * from_seconds(kStep_s);
    out.sequence = static_cast<std::uint64_t>(step);
    return out;
  }

  FusionEngine engine;
  std::vector<Verdict> verdicts;

 private:
  int steps_ = 0;
};

/// From the first verdict to the final one, with nothing missing.
void expect_settled(const std::vector<Verdict>& said) {
  ASSERT_FALSE(said.empty());
  for (std::size_t i = 0; i < said.size(); ++i) {
    EXPECT_EQ(said[i].revision, i);
    EXPECT_EQ(said[i].is_final, i + 1 == said.size()) << i;
    EXPECT_EQ(said[i].previous, i == 0 ? said[i].kind : said[i - 1].kind) << i;
    EXPECT_EQ(said[i].writer, Name("receiver"));
  }
}

TEST(Revision, TheLastWordIsWhatTheStateDoes) {
  Adrift vehicle;
  vehicle.steps(20);
  vehicle.fix(20, 250.0);
  vehicle.steps(2);
  EXPECT_GT(vehicle.north_m(), 50.0);
  ASSERT_EQ(vehicle.of(20).size(), 1U);
  EXPECT_EQ(vehicle.of(20).front().kind, VerdictKind::used);
  EXPECT_FALSE(vehicle.of(20).front().is_final);

  vehicle.fix(18, 0.0);
  vehicle.steps(1);
  EXPECT_NEAR(vehicle.north_m(), 0.0, 3.0);
  ASSERT_EQ(vehicle.of(20).size(), 2U) << "said at once";
  EXPECT_EQ(vehicle.of(20).back().kind, VerdictKind::rejected);
  EXPECT_EQ(vehicle.of(20).back().previous, VerdictKind::used);
  EXPECT_GT(vehicle.of(20).back().test_ratio, 1.0);
  EXPECT_FALSE(vehicle.of(20).back().is_final);

  // The horizon of 2 s is over for the one stamped at 2.0 s with the first sample after 4.0 s.
  vehicle.steps(17);
  EXPECT_EQ(vehicle.of(20).size(), 2U);
  EXPECT_TRUE(vehicle.of(18).back().is_final);
  vehicle.steps(1);
  EXPECT_EQ(vehicle.of(20).size(), 3U);
  expect_settled(vehicle.of(20));
  expect_settled(vehicle.of(18));
  EXPECT_EQ(vehicle.of(20).back().kind, VerdictKind::rejected);
  EXPECT_EQ(vehicle.of(20).back().innovation[0], vehicle.of(20)[1].innovation[0]);
  EXPECT_EQ(vehicle.of(18).size(), 2U);
  EXPECT_EQ(vehicle.of(18).back().kind, VerdictKind::used);

  vehicle.fix(20, 250.0);
  vehicle.steps(40);
  EXPECT_EQ(vehicle.of(20).size(), 4U) << "too late, and final at once";
  EXPECT_EQ(vehicle.of(20).back().kind, VerdictKind::late);
  EXPECT_TRUE(vehicle.of(20).back().is_final);
  EXPECT_EQ(vehicle.of(20).back().revision, 0U);
  EXPECT_EQ(vehicle.of(18).size(), 2U);
}

TEST(Revision, TheFinalWordHasTheInnovationOfTheEnd) {
  Adrift vehicle;
  vehicle.steps(20);
  vehicle.fix(20, 3.0);
  vehicle.steps(2);
  vehicle.fix(18, 0.0);
  vehicle.steps(30);
  const auto said = vehicle.of(20);
  ASSERT_EQ(said.size(), 2U) << "used before and after: no word in between";
  expect_settled(said);
  EXPECT_LT(said[1].innovation_sigma[0], 0.2 * said[0].innovation_sigma[0]);
}

TEST(Revision, ASecondNavigatorRevisesAsItPasses) {
  Adrift vehicle([](EngineConfig& c) {
    c.replay_steps_per_sample = 2;
    c.horizon_s = 4.0;
  });
  vehicle.steps(20);
  vehicle.fix(20, 250.0);
  vehicle.steps(10);
  vehicle.fix(18, 0.0);
  vehicle.steps(1);
  ASSERT_TRUE(vehicle.engine.catching_up());
  int more = 0;
  for (; vehicle.engine.catching_up(); ++more) vehicle.steps(1);
  EXPECT_LE(more, 31);
  EXPECT_NEAR(vehicle.north_m(), 0.0, 3.0);
  EXPECT_EQ(vehicle.of(20).back().kind, VerdictKind::rejected);
  vehicle.steps(41);
  EXPECT_EQ(vehicle.of(20).size(), 3U);
  expect_settled(vehicle.of(20));
  expect_settled(vehicle.of(18));
}

TEST(Revision, WhatIsRefusedOutrightIsFinalAtOnce) {
  Adrift vehicle;
  vehicle.fix(1, 0.0);
  ASSERT_EQ(vehicle.verdicts.size(), 1U) << "before the first inertial sample";
  EXPECT_EQ(vehicle.verdicts.back().kind, VerdictKind::not_aligned);
  expect_settled(vehicle.of(1));
  vehicle.steps(30);
  vehicle.fix(50, 0.0);
  EXPECT_EQ(vehicle.verdicts.back().kind, VerdictKind::from_the_future);
  expect_settled(vehicle.of(50));
  vehicle.fix(5, 0.0);
  EXPECT_EQ(vehicle.verdicts.back().kind, VerdictKind::late);
  expect_settled(vehicle.of(5));
  DepthSample stray;
  stray.header = Adrift::header("stranger", 29);
  vehicle.engine.add(stray, "receiver");
  vehicle.take();
  EXPECT_EQ(vehicle.verdicts.back().kind, VerdictKind::source_disabled);
  expect_settled(vehicle.of(29));
  ImuSample again;
  again.header = Adrift::header("imu", 30);
  EXPECT_FALSE(vehicle.engine.add(again));
  vehicle.take();
  EXPECT_EQ(vehicle.verdicts.size(), 5U);
  EXPECT_TRUE(vehicle.verdicts.back().is_final);
}

TEST(Revision, TheEndOfARecordingIsFinal) {
  Adrift vehicle;
  vehicle.steps(20);
  vehicle.fix(20, 250.0);
  vehicle.steps(2);
  vehicle.fix(18, 0.0);
  vehicle.fix(23, 0.0);
  vehicle.engine.finish();
  vehicle.take();
  for (const int step : {18, 20, 23}) expect_settled(vehicle.of(step));
  EXPECT_EQ(vehicle.of(20).back().kind, VerdictKind::rejected);
  EXPECT_EQ(vehicle.of(23).back().kind, VerdictKind::from_the_future);
  EXPECT_EQ(vehicle.of(23).size(), 1U);
  EXPECT_NEAR(vehicle.north_m(), 0.0, 3.0);
  const std::size_t said = vehicle.verdicts.size();
  vehicle.engine.finish();
  vehicle.take();
  EXPECT_EQ(vehicle.verdicts.size(), said);
  vehicle.fix(19, 100.0);
  EXPECT_EQ(vehicle.verdicts.back().kind, VerdictKind::late);
  vehicle.steps(30);
  EXPECT_EQ(vehicle.verdicts.size(), said + 1);
}

TEST(Revision, InertialSamplesThatBeginAnewEndThePast) {
  Adrift vehicle;
  vehicle.steps(20);
  vehicle.fix(20, 0.0);
  vehicle.steps(2);
  vehicle.fix(21, 1.0);  // has not acted when they stop
  const std::size_t before = vehicle.of(20).size();
  ImuSample later;
  later.specific_force_B_m_s2 = {0.0, 0.0, -9.8};
  later.angular_rate_B_rad_s = {0.0, 0.0, 0.0};
  bool taken = false;
  later.header = Adrift::header("imu", 600);
  for (int i = 0; i < 50 && !taken; ++i) {
    EXPECT_EQ(vehicle.of(20).size(), before);
    taken = vehicle.engine.add(later);
    vehicle.take();
    later.header.stamp_ns += 20'000'000;
  }
  ASSERT_TRUE(taken);
  ASSERT_FALSE(vehicle.of(21).empty());
  expect_settled(vehicle.of(20));
  EXPECT_EQ(vehicle.of(20).back().kind, VerdictKind::used);
  expect_settled(vehicle.of(21));
  EXPECT_EQ(vehicle.of(21).back().kind, VerdictKind::late);
}

TEST(Revision, WhenTheRoomRunsOutTheOldestAreFinal) {
  Adrift vehicle([](EngineConfig& c) {
    c.horizon_s = 60.0;
    c.sensors[0].frozen_change = 0.0;
  });
  vehicle.steps(1);
  for (int step = 2; step <= 150; ++step) {
    vehicle.steps(1);
    vehicle.fix(step, 0.0);
  }
  vehicle.steps(1);
  int finals = 0;
  for (int step = 2; step <= 150; ++step) {
    const auto said = vehicle.of(step);
    ASSERT_FALSE(said.empty()) << step;
    if (said.back().is_final) {
      expect_settled(said);
      ++finals;
    }
  }
  EXPECT_GE(finals, 149 - 64);
  EXPECT_LT(finals, 149 - 32);
  vehicle.engine.finish();
  vehicle.take();
  for (int step = 2; step <= 150; ++step) expect_settled(vehicle.of(step));
}

TEST(Revision, GoesOnInAnEngineThatTakesUpTheState) {
  Adrift vehicle;
  vehicle.steps(20);
  vehicle.fix(20, 250.0);
  vehicle.steps(2);
  vehicle.fix(18, 0.0);  // has not acted yet
  std::vector<std::byte> image;
  ASSERT_TRUE(vehicle.engine.save(image));
  Adrift other;
  other.verdicts = vehicle.verdicts;
  ASSERT_EQ(other.engine.restore(image), "");
  other.take();
  EXPECT_EQ(other.of(20).back().kind, VerdictKind::rejected);
  other.engine.finish();
  other.take();
  expect_settled(other.of(18));
  expect_settled(other.of(20));
}

TEST(Revision, NothingIsSaidOfThePastThatAStateReplaces) {
  Adrift vehicle;
  vehicle.steps(20);
  vehicle.fix(20, 0.0);
  vehicle.steps(2);
  vehicle.take();
  std::vector<std::byte> image;
  ASSERT_TRUE(vehicle.engine.save(image));
  // The other one has heard the same, and holds it too.
  Adrift other;
  other.steps(20);
  other.fix(20, 0.0);
  other.steps(2);
  other.take();
  const std::size_t said = other.of(20).size();
  ASSERT_EQ(other.engine.restore(image), "");
  other.take();
  EXPECT_EQ(other.of(20).size(), said);
  other.engine.finish();
  other.take();
  expect_settled(other.of(20));
}

TEST(Revision, WordsThatNobodyTakesAreCounted) {
  Adrift vehicle;
  vehicle.steps(1);
  const std::size_t room = 1024 + std::size_t{2} * 64;
  ImuSample again;
  again.header = Adrift::header("imu", 1);
  for (std::size_t i = 0; i < room + 7; ++i) EXPECT_FALSE(vehicle.engine.add(again));
  EXPECT_EQ(vehicle.engine.verdicts_dropped(), 7U);
  vehicle.take();
  EXPECT_EQ(vehicle.verdicts.size(), room);
}

TEST(Revision, ATallyCountsEachMeasurementOnce) {
  const auto verdict = [](VerdictKind kind, std::uint32_t revision, VerdictKind previous, bool is_final) {
    Verdict out;
    out.kind = kind;
    out.revision = revision;
    out.previous = previous;
    out.is_final = is_final;
    return out;
  };
  VerdictTally tally;
  tally.add(verdict(VerdictKind::used, 0, VerdictKind::used, false));
  EXPECT_EQ(tally[VerdictKind::used], 1U);
  tally.add(verdict(VerdictKind::rejected, 1, VerdictKind::used, false));
  EXPECT_EQ(tally[VerdictKind::used], 0U);
  EXPECT_EQ(tally[VerdictKind::rejected], 1U);
  tally.add(verdict(VerdictKind::rejected, 2, VerdictKind::rejected, true));
  tally.add(verdict(VerdictKind::late, 0, VerdictKind::late, true));
  EXPECT_EQ(tally.sum(), 2U);
  // Of a measurement whose first verdict was not heard.
  tally.add(verdict(VerdictKind::frozen, 1, VerdictKind::used, false));
  EXPECT_EQ(tally.sum(), 2U);
}

}  // namespace
}  // namespace fathom::estimation
