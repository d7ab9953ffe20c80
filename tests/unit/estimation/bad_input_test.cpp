#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/orders.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An engine some way into a survey, in the middle of the dive.
class BadInput : public ::testing::Test {
 protected:
  BadInput() : survey_({.duration_s = 62.0}), engine_(SurveyRun::config()) {
    for (const test::Sample& sample : survey_.samples) {
      test::feed(engine_, sample);
      if (const auto* imu = std::get_if<ImuSample>(&sample)) imu_ = *imu;
      if (const auto* dvl = std::get_if<DvlSample>(&sample)) dvl_ = *dvl;
      if (const auto* gps = std::get_if<GpsSample>(&sample)) gps_ = *gps;
      if (const auto* depth = std::get_if<DepthSample>(&sample)) depth_ = *depth;
      if (const auto* heading = std::get_if<HeadingSample>(&sample)) heading_ = *heading;
    }
    step();
    drain();
  }

  void drain() {
    Verdict verdict;
    while (engine_.next_verdict(verdict)) last_ = verdict;
  }
  /// The next one that says something new: not the final word on what was judged before.
  bool next_news(Verdict& verdict) {
    while (engine_.next_verdict(verdict))
      if (is_news(verdict)) return true;
    return false;
  }
  /// The next inertial sample, like the last.
  void step() {
    imu_.header.stamp_ns += 10'000'000;
    ++imu_.header.sequence;
    ASSERT_TRUE(engine_.add(imu_));
  }
  /// Feeds a sample and gives the one verdict that follows it and the next inertial sample.
  template <class Sample>
  VerdictKind judge(Sample sample, bool fresh = true) {
    drain();
    if (fresh) {
      sample.header.stamp_ns = imu_.header.stamp_ns + 5'000'000;
      sample.header.sequence += 1000;
    }
    engine_.add(sample);
    step();
    Verdict verdict;
    EXPECT_TRUE(next_news(verdict));
    last_ = verdict;
    Verdict second;
    EXPECT_FALSE(next_news(second)) << to_string(second.kind);
    return verdict.kind;
  }
  [[nodiscard]] bool finite() const {
    const NavState& nav = engine_.nav_state();
    return std::isfinite(nav.latitude_rad) && std::isfinite(nav.velocity_N_m_s[0]) &&
           std::isfinite(nav.q_NB[0]) && std::isfinite(nav.position_covariance_N_m2[0]);
  }

  SurveyRun survey_;
  FusionEngine engine_;
  ImuSample imu_;
  DvlSample dvl_;
  GpsSample gps_;
  DepthSample depth_;
  HeadingSample heading_;
  Verdict last_;
};

TEST_F(BadInput, InertialSamplesThatMustNotMoveTheState) {
  struct Case {
    const char* what;
    void (*spoil)(ImuSample&);
    VerdictKind verdict;
  };
  const Case cases[] = {
      {"not a number", [](ImuSample& s) { s.angular_rate_B_rad_s[1] = s.delta_angle_B_rad[1] = kNaN; },
       VerdictKind::out_of_range},
      {"infinite", [](ImuSample& s) { s.specific_force_B_m_s2[2] = s.delta_velocity_B_m_s[2] = kInfinity; },
       VerdictKind::out_of_range},
      {"absurd rate", [](ImuSample& s) { s.delta_angle_B_rad[0] = 10.0; }, VerdictKind::out_of_range},
      {"absurd force", [](ImuSample& s) { s.delta_velocity_B_m_s[0] = 1e4; }, VerdictKind::out_of_range},
      {"same stamp", [](ImuSample& s) { s.header.stamp_ns -= 10'000'000; }, VerdictKind::duplicate},
      {"older stamp", [](ImuSample& s) { s.header.stamp_ns -= 500'000'000; }, VerdictKind::late},
      {"far ahead", [](ImuSample& s) { s.header.stamp_ns += 3600 * kNsPerSecond; },
       VerdictKind::from_the_future},
      {"before the epoch", [](ImuSample& s) { s.header.stamp_ns = -5; }, VerdictKind::late},
  };
  for (const Case& one : cases) {
    const NavState before = engine_.nav_state();
    ImuSample bad = imu_;
    bad.header.stamp_ns += 10'000'000;
    one.spoil(bad);
    EXPECT_FALSE(engine_.add(bad)) << one.what;
    Verdict verdict;
    ASSERT_TRUE(engine_.next_verdict(verdict)) << one.what;
    EXPECT_EQ(verdict.kind, one.verdict) << one.what;
    EXPECT_EQ(verdict.source, SourceKind::imu);
    EXPECT_FALSE(engine_.next_verdict(verdict));
    const NavState& after = engine_.nav_state();
    EXPECT_EQ(before.latitude_rad, after.latitude_rad) << one.what;
    EXPECT_EQ(before.q_NB, after.q_NB) << one.what;
    EXPECT_EQ(before.header.sequence, after.header.sequence) << one.what;
  }
  step();
  EXPECT_TRUE(finite());
}

TEST_F(BadInput, NewTimeAxisIsTakenUpAfterTenSamples) {
  ImuSample sample = imu_;
  sample.header.stamp_ns -= 3600 * kNsPerSecond;
  int refused = 0;
  for (int i = 0; i < 50; ++i) {
    sample.header.stamp_ns += 10'000'000;
    sample.header.received_ns += 10'000'000;
    if (!engine_.add(sample)) ++refused;
  }
  EXPECT_EQ(refused, 9);
  EXPECT_TRUE(finite());
  EXPECT_EQ(engine_.nav_state().header.stamp_ns, sample.header.stamp_ns);
  EXPECT_GE(engine_.nav_state().gps_outage_s, 10.0);
  EXPECT_LE(engine_.nav_state().gps_outage_s, 20.0);
}

TEST_F(BadInput, AidingSamples) {
  const double latitude = engine_.nav_state().latitude_rad;
  DvlSample dvl = dvl_;
  dvl.velocity_D_m_s = {kNaN, kNaN, kNaN};
  EXPECT_EQ(judge(dvl), VerdictKind::out_of_range);
  dvl.velocity_D_m_s = {kInfinity, 0.0, 0.0};
  EXPECT_EQ(judge(dvl), VerdictKind::out_of_range);
  dvl.velocity_D_m_s = {1e9, 0.0, 0.0};
  EXPECT_EQ(judge(dvl), VerdictKind::out_of_range);
  dvl.velocity_D_m_s = {-40.0, 30.0, 0.0};
  EXPECT_EQ(judge(dvl), VerdictKind::rejected);
  EXPECT_GT(last_.test_ratio, 1.0);
  dvl = dvl_;
  dvl.velocity_D_m_s[1] = kNaN;  // two good components are used
  EXPECT_EQ(judge(dvl), VerdictKind::used);
  EXPECT_EQ(last_.dimensions, 2U);

  GpsSample gps = gps_;
  gps.fix = GpsFix::none;
  EXPECT_EQ(judge(gps), VerdictKind::no_fix);
  gps = gps_;
  gps.altitude_m = 1e5;  // neither the place nor the velocity of such a receiver
  EXPECT_EQ(judge(gps), VerdictKind::out_of_range);
  gps = gps_;
  gps.spoofing = GpsSpoofing::affirmed;
  EXPECT_EQ(judge(gps), VerdictKind::out_of_range);
  gps.spoofing = GpsSpoofing::indicated;  // a sign is no proof
  EXPECT_NE(judge(gps), VerdictKind::out_of_range);
  gps = gps_;
  gps.latitude_rad = kNaN;
  gps.velocity_N_m_s = {kNaN, kNaN, kNaN};
  EXPECT_EQ(judge(gps), VerdictKind::out_of_range);
  gps = gps_;
  gps.latitude_rad += 0.01;
  EXPECT_EQ(judge(gps), VerdictKind::rejected);

  DepthSample depth = depth_;
  depth.depth_m = 1e6;
  EXPECT_EQ(judge(depth), VerdictKind::out_of_range);
  depth.depth_m = kNaN;
  EXPECT_EQ(judge(depth), VerdictKind::out_of_range);

  HeadingSample heading = heading_;
  heading.heading_rad = kNaN;
  EXPECT_EQ(judge(heading), VerdictKind::out_of_range);
  heading = heading_;
  heading.north = North::magnetic;  // no variation known
  EXPECT_EQ(judge(heading), VerdictKind::unknown_frame);

  UsblSample usbl;
  usbl.header = dvl_.header;
  usbl.header.sensor = "usbl0";
  usbl.frame = UsblFrame::vessel_frd;
  usbl.relative_m = {10.0, 0.0, 5.0};
  EXPECT_EQ(judge(usbl), VerdictKind::unknown_frame);  // relative to a ship of which nothing is known

  AirspeedSample air;
  air.header = dvl_.header;
  air.header.sensor = "pitot0";
  air.airspeed_m_s = 20.0;
  EXPECT_EQ(judge(air), VerdictKind::source_disabled);  // not in the configuration
  EXPECT_TRUE(finite());
  EXPECT_LT(std::abs(engine_.nav_state().latitude_rad - latitude) * 6.4e6, 5.0);
}

TEST_F(BadInput, RelativeAcousticFixes) {
  const NavState nav = engine_.nav_state();
  UsblSample good;
  good.header = dvl_.header;
  good.header.sensor = "usbl0";
  good.frame = UsblFrame::vessel_frd;
  good.station_latitude_rad = nav.latitude_rad;
  good.station_longitude_rad = nav.longitude_rad;
  good.station_depth_m = nav.depth_m - 30.0;
  good.station_rpy_rad = {0.02, -0.01, 1.0};
  good.range_m = 30.0;
  good.bearing_rad = 2.0;
  good.depression_rad = 1.5;
  EXPECT_EQ(judge(good), VerdictKind::used);
  EXPECT_EQ(last_.dimensions, 3U);
  UsblSample usbl = good;
  for (const double range_m : {0.0, -30.0, kInfinity, 1e7}) {
    usbl.range_m = range_m;
    EXPECT_EQ(judge(usbl), VerdictKind::out_of_range) << range_m;
  }
  usbl = good;
  for (const double bearing_rad : {7.0, -7.0, kInfinity}) {
    usbl.bearing_rad = bearing_rad;
    EXPECT_EQ(judge(usbl), VerdictKind::out_of_range) << bearing_rad;
  }
  usbl = good;
  usbl.depression_rad = 1.6;
  EXPECT_EQ(judge(usbl), VerdictKind::out_of_range);
  usbl = good;
  usbl.station_latitude_rad = kNaN;
  EXPECT_EQ(judge(usbl), VerdictKind::unknown_frame);
  usbl.station_latitude_rad = 2.0;
  EXPECT_EQ(judge(usbl), VerdictKind::out_of_range);
  usbl = good;
  usbl.station_depth_m = 1e6;
  EXPECT_EQ(judge(usbl), VerdictKind::out_of_range);
  usbl = good;
  usbl.station_rpy_rad[2] = kNaN;  // along the ship, but how does she lie?
  EXPECT_EQ(judge(usbl), VerdictKind::unknown_frame);
  usbl.frame = UsblFrame::ned;  // along north that does not matter
  EXPECT_NE(judge(usbl), VerdictKind::unknown_frame);
  usbl = good;
  usbl.range_m = usbl.bearing_rad = usbl.depression_rad = kNaN;  // nothing at all
  EXPECT_EQ(judge(usbl), VerdictKind::out_of_range);
  usbl.relative_m = {1e7, 0.0, 0.0};
  EXPECT_EQ(judge(usbl), VerdictKind::out_of_range);
  usbl = good;
  usbl.bearing_rad = usbl.depression_rad = kNaN;  // a range alone is used
  EXPECT_EQ(judge(usbl), VerdictKind::used);
  EXPECT_EQ(last_.dimensions, 1U);
  EXPECT_TRUE(finite());
}

TEST_F(BadInput, PlacesInTime) {
  DvlSample dvl = dvl_;
  EXPECT_EQ(judge(dvl), VerdictKind::used);
  dvl.header = last_.header;
  EXPECT_EQ(judge(dvl, false), VerdictKind::duplicate);
  ++dvl.header.sequence;  // the same instant under another number
  EXPECT_EQ(judge(dvl, false), VerdictKind::duplicate);
  dvl.header.stamp_ns -= 10 * kNsPerSecond;
  EXPECT_EQ(judge(dvl, false), VerdictKind::late);
  dvl.header.stamp_ns = imu_.header.stamp_ns + 2 * kNsPerSecond;
  EXPECT_EQ(judge(dvl, false), VerdictKind::from_the_future);
}

TEST_F(BadInput, FrozenFixIsNotTrusted) {
  // The receiver repeats its last fix, in good health, while the vehicle goes on.
  EngineConfig config = SurveyRun::config();
  FusionEngine engine(config);
  const SurveyRun run({.duration_s = 49.0});
  std::optional<GpsSample> frozen;
  int used_late = 0;
  int frozen_verdicts = 0;
  for (test::Sample sample : run.samples) {
    if (auto* gps = std::get_if<GpsSample>(&sample)) {
      if (to_seconds(gps->header.stamp_ns - SurveyRun::kEpochNs) > 40.0) {
        if (!frozen) frozen = *gps;
        const SampleHeader header = gps->header;
        *gps = *frozen;
        gps->header = header;
      }
    }
    test::feed(engine, sample);
    Verdict verdict;
    while (engine.next_verdict(verdict)) {
      if (verdict.source != SourceKind::gps || !is_news(verdict)) continue;
      if (verdict.kind == VerdictKind::frozen) ++frozen_verdicts;
      if (verdict.kind == VerdictKind::used &&
          to_seconds(verdict.header.stamp_ns - SurveyRun::kEpochNs) > 42.5)
        ++used_late;
    }
  }
  EXPECT_GE(frozen_verdicts, 10);
  EXPECT_EQ(used_late, 0);
}

TEST_F(BadInput, AWaterLayerIsAnInstrumentOfItsOwn) {
  DvlSample layer = dvl_;
  layer.mode = DvlMode::water;
  layer.header.stamp_ns = dvl_.header.stamp_ns = imu_.header.stamp_ns + 5'000'000;
  dvl_.header.sequence += 1000;
  layer.header.sequence = dvl_.header.sequence + 1;
  drain();
  engine_.add(dvl_);
  engine_.add(layer);
  ++layer.header.sequence;
  engine_.add(layer);  // once more
  step();
  std::vector<std::string_view> kinds;
  for (Verdict verdict; next_news(verdict);) kinds.push_back(to_string(verdict.kind));
  EXPECT_EQ(kinds, (std::vector<std::string_view>{"used", "used", "duplicate"}));
}

TEST_F(BadInput, SourceCanBeSwitchedOffAndOn) {
  Command command;
  command.kind = CommandKind::disable_source;
  command.target = "dvl0";
  EXPECT_EQ(test::order_now(engine_, command), "");
  EXPECT_EQ(judge(dvl_), VerdictKind::source_disabled);
  command.kind = CommandKind::enable_source;
  EXPECT_EQ(test::order_now(engine_, command), "");
  EXPECT_EQ(judge(dvl_), VerdictKind::used);
  command.target = "nobody";
  EXPECT_NE(test::order_now(engine_, command), "");
}

TEST_F(BadInput, PositionIsSetByOrderOnly) {
  Command command;
  command.kind = CommandKind::set_position;
  command.latitude_rad = engine_.nav_state().latitude_rad + 1e-5;
  command.longitude_rad = engine_.nav_state().longitude_rad;
  command.sigma_m = kNaN;
  EXPECT_NE(test::order_now(engine_, command), "");
  command.sigma_m = 5.0;
  EXPECT_EQ(test::order_twice(engine_, command), "");
  step();
  const NavState& nav = engine_.nav_state();
  EXPECT_NEAR(nav.latitude_rad, command.latitude_rad, 2e-8);
  EXPECT_EQ(nav.reset_counter, 1U);
  EXPECT_NEAR(nav.last_reset_delta_N_m[0], 63.6, 0.3);
  EXPECT_NEAR(nav.position_covariance_N_m2[0], 25.0, 0.5);
}

TEST_F(BadInput, GapsWidenTheUncertaintyAndLongOnesEndIt) {
  const double before = engine_.nav_state().velocity_covariance_N_m2_s2[0];
  imu_.header.stamp_ns += 2 * kNsPerSecond;
  step();
  EXPECT_GT(engine_.nav_state().velocity_covariance_N_m2_s2[0], before + 1.0);
  EXPECT_NE(engine_.nav_state().mode, NavMode::none);
  EXPECT_TRUE(finite());
}

TEST(Rejections, ThatAgreeForLongEnoughAreBelieved) {
  // The estimate is put 200 m away with a sigma of a metre: GPS is refused, and then believed.
  const SurveyRun run({.duration_s = 58.0, .dive_s = 1e9});
  FusionEngine engine(SurveyRun::config());
  bool set = false;
  double rejected_s = 0.0;
  double error_m = 0.0;
  for (const test::Sample& sample : run.samples) {
    test::feed(engine, sample);
    const double t = to_seconds(engine.nav_state().header.stamp_ns - SurveyRun::kEpochNs);
    if (!set && t > 30.0) {
      Command command;
      command.kind = CommandKind::set_position;
      command.latitude_rad = engine.nav_state().latitude_rad + 200.0 / 6.37e6;
      command.longitude_rad = engine.nav_state().longitude_rad;
      command.sigma_m = 1.0;
      set = test::order_twice(engine, command).empty();
    }
    Verdict verdict;
    while (engine.next_verdict(verdict))
      if (is_news(verdict) && verdict.source == SourceKind::gps && verdict.kind == VerdictKind::rejected)
        rejected_s += 0.5;
  }
  const Truth& truth = run.truth.back();
  const NavState& nav = engine.nav_state();
  error_m = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                              {nav.latitude_rad, nav.longitude_rad, nav.altitude_m})
                .norm();
  EXPECT_TRUE(set);
  EXPECT_GE(rejected_s, 20.0);
  EXPECT_LE(rejected_s, 24.0);
  EXPECT_LT(error_m, 5.0);
  // The order, then the way back in steps.
  EXPECT_GE(nav.reset_counter, 3U);
  EXPECT_LT(nav.last_reset_delta_N_m[0], 0.0);
  EXPECT_GE(nav.last_reset_delta_N_m[0], -101.0);
}

TEST(GivenStart, HoldsAtItsInstantOrWhenNavigationBegins) {
  for (const bool stamped : {false, true}) {
    FusionEngine engine(SurveyRun::config());
    InitialState start;
    start.stamp_ns = stamped ? SurveyRun::kEpochNs : 0;
    start.latitude_rad = 0.6;
    start.longitude_rad = 2.0;
    start.altitude_m = 400.0;
    start.velocity_N_m_s = {60.0, 0.0, 0.0};
    engine.start_from(start);
    ImuSample imu;
    imu.header.stamp_ns = SurveyRun::kEpochNs + from_seconds(0.5);
    imu.angular_rate_B_rad_s = {0.0, 0.0, 0.0};
    imu.specific_force_B_m_s2 = {0.0, 0.0, -9.8};
    ASSERT_TRUE(engine.add(imu));
    const NavState& nav = engine.nav_state();
    const double north = (nav.latitude_rad - 0.6) * (geo::radii(0.6).meridian_m + 400.0);
    EXPECT_NEAR(north, stamped ? 30.0 : 0.0, 0.01);
    EXPECT_NEAR(nav.longitude_rad, 2.0, 1e-12);
    EXPECT_NE(nav.mode, NavMode::none);
  }
}

TEST(Configuration, IsRefusedWithKeyAndExpectation) {
  EngineConfig config = SurveyRun::config();
  EXPECT_EQ(config.validate(), "");
  config.sensors[1].sigma[0] = -1.0;
  EXPECT_NE(config.validate().find("sensors.1.sigma_m_s.0: -1: expected"), std::string::npos);
  EXPECT_THROW(FusionEngine{config}, std::invalid_argument);
  config = SurveyRun::config();
  config.sensors[1].sensor = config.sensors[0].sensor;
  EXPECT_NE(config.validate(), "");
  config = SurveyRun::config();
  config.horizon_s = kNaN;
  EXPECT_NE(config.validate(), "");
}

}  // namespace
}  // namespace fathom::estimation
