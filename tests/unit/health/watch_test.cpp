#include <string>

#include <gtest/gtest.h>

#include "health/gps/dispute_watch.hpp"
#include "health/instruments/sensor_watch.hpp"
#include "health/navigation/nav_watch.hpp"
#include "health/writers/service_watch.hpp"
#include "samples/uncertainty.hpp"
#include "timeline.hpp"

namespace fathom::health {
namespace {

TEST(StreamWatch, GoesThroughItsStates) {
  StreamWatch stream(StreamLimits::from_rate(5.0), at(0.0).monotonic_ns);
  stream.evaluate(at(100.0).monotonic_ns);
  EXPECT_EQ(stream.presence(), Presence::never_seen);
  EXPECT_TRUE(std::isnan(stream.age_s(at(100.0).monotonic_ns)));
  for (double t = 100.0; t < 110.0; t += 0.2) stream.heard(at(t).monotonic_ns);
  EXPECT_EQ(stream.presence(), Presence::present);
  EXPECT_NEAR(stream.rate_hz(at(110.0).monotonic_ns), 5.0, 0.3);
  stream.evaluate(at(110.7).monotonic_ns);
  EXPECT_EQ(stream.presence(), Presence::stale);
  stream.evaluate(at(112.0).monotonic_ns);
  EXPECT_EQ(stream.presence(), Presence::missing);
  stream.heard(at(113.0).monotonic_ns);
  stream.heard(at(113.2).monotonic_ns);
  EXPECT_EQ(stream.presence(), Presence::missing) << "two samples are not yet a stream";
  stream.heard(at(113.4).monotonic_ns);
  EXPECT_EQ(stream.presence(), Presence::present);
}

TEST(StreamWatch, RatesOfFastAndSlowStreams) {
  for (const double rate : {0.1, 0.2, 1.0, 10.0, 100.0, 400.0}) {
    StreamWatch stream(StreamLimits::from_rate(rate), at(0.0).monotonic_ns);
    const double span = std::max(20.0, 20.0 / rate);
    for (double t = 0.0; t < span; t += 1.0 / rate) stream.heard(at(t).monotonic_ns);
    EXPECT_NEAR(stream.rate_hz(at(span).monotonic_ns), rate, 0.3 * rate) << rate;
    EXPECT_EQ(stream.presence(), Presence::present) << rate;
    EXPECT_FALSE(stream.slow());
  }
}

TEST(StreamWatch, SlowHasHysteresisAndNeedsAWholeWindow) {
  StreamWatch stream(StreamLimits::from_rate(100.0), at(0.0).monotonic_ns);
  double t = 0.0;
  const auto run = [&](double seconds, double rate) {
    for (const double end = t + seconds; t < end; t += 1.0 / rate) stream.heard(at(t).monotonic_ns);
  };
  run(4.0, 30.0);
  EXPECT_FALSE(stream.slow()) << "too early to say";
  run(4.0, 30.0);
  EXPECT_TRUE(stream.slow());
  run(10.0, 60.0);
  EXPECT_TRUE(stream.slow()) << "between the limits it stays as it was";
  run(10.0, 100.0);
  EXPECT_FALSE(stream.slow());
  run(10.0, 60.0);
  EXPECT_FALSE(stream.slow());
}

TEST(SensorWatch, MissingAfterTheLimitBackAfterARunAndNeverFlapping) {
  const std::vector<ExpectedSensor> expected{{"dvl", SourceKind::dvl, 5.0, 0.0, Severity::warning}};
  SensorWatch watch(expected, 15.0, at(0.0));
  AlarmBook book;
  const auto step = [&](double t) {
    watch.evaluate(at(t));
    watch.report(book, at(t));
  };
  for (int i = 0; i < 100; ++i) watch.heard(SourceKind::dvl, "dvl", at(0.2 * i)), step(0.2 * i);
  EXPECT_EQ(book.all().size(), 0u);
  step(21.5);
  EXPECT_FALSE(alarmed(book, "sensor_missing:dvl"));
  step(22.1);
  EXPECT_TRUE(alarmed(book, "sensor_missing:dvl"));
  EXPECT_NEAR(to_seconds(book.find("sensor_missing:dvl")->since_ns - kEpoch), 19.8, 0.01);
  (void)book.take_transitions();
  // One sample every 1.5 s is no recovery: the alarm stays as it is.
  for (double t = 23.0; t < 60.0; t += 1.5)
    watch.heard(SourceKind::dvl, "dvl", at(t)), step(t), step(t + 0.7);
  EXPECT_TRUE(alarmed(book, "sensor_missing:dvl"));
  EXPECT_TRUE(book.take_transitions().empty());
  for (double t = 60.0; t < 62.0; t += 0.2) watch.heard(SourceKind::dvl, "dvl", at(t)), step(t);
  EXPECT_FALSE(alarmed(book, "sensor_missing:dvl"));
}

TEST(SensorWatch, AnAlarmThatEndsKeepsTheLengthOfTheOutage) {
  const std::vector<ExpectedSensor> expected{{"gps", SourceKind::gps, 5.0, 0.0, Severity::warning}};
  SensorWatch watch(expected, 15.0, at(0.0));
  AlarmBook book;
  const auto step = [&](double t) { watch.evaluate(at(t)), watch.report(book, at(t)); };
  for (double t = 0.0; t < 20.05; t += 0.2) watch.heard(SourceKind::gps, "gps", at(t)), step(t);
  for (double t = 20.5; t < 36.9; t += 0.5) step(t);
  for (double t = 37.0; t < 40.0; t += 0.2)
    watch.heard(SourceKind::gps, "gps", at(t)), step(t), step(t + 0.1);
  ASSERT_FALSE(alarmed(book, "sensor_missing:gps"));
  EXPECT_NE(book.find("sensor_missing:gps")->text.find("for 17.0 s (limit 2.0 s)"), std::string::npos)
      << book.find("sensor_missing:gps")->text;
  EXPECT_NEAR(book.find("sensor_missing:gps")->value, 17.0, 0.05);
  // The next outage is measured on its own.
  step(43.0);
  ASSERT_TRUE(alarmed(book, "sensor_missing:gps"));
  EXPECT_NEAR(book.find("sensor_missing:gps")->value, 3.2, 0.25);
}

TEST(SensorWatch, NeverHeardIsAnAlarmAfterTheStartAndUnexpectedSensorsAreOnlyListed) {
  SensorWatch watch({{"imu", SourceKind::imu, 100.0, 0.0, Severity::critical}}, 15.0, at(0.0));
  AlarmBook book;
  watch.heard(SourceKind::usbl, "usbl", at(1.0));
  watch.evaluate(at(14.0));
  watch.report(book, at(14.0));
  EXPECT_FALSE(alarmed(book, "sensor_missing:imu"));
  watch.evaluate(at(100.0));
  watch.report(book, at(100.0));
  ASSERT_TRUE(alarmed(book, "sensor_missing:imu"));
  EXPECT_EQ(book.find("sensor_missing:imu")->severity, Severity::critical);
  EXPECT_NE(book.find("sensor_missing:imu")->text.find("never since"), std::string::npos);
  EXPECT_EQ(book.all().size(), 1u);
  const auto items = watch.items(at(100.0));
  ASSERT_EQ(items.size(), 2u);
  EXPECT_EQ(items[0].presence, Presence::never_seen);
  EXPECT_EQ(items[1].presence, Presence::missing);
}

TEST(SensorWatch, SameNameOfTwoKindsIsTwoSensorsAndTheListIsBounded) {
  SensorWatch watch({}, 15.0, at(0.0));
  watch.heard(SourceKind::fins, "actuators", at(0.0));
  watch.heard(SourceKind::propulsion, "actuators", at(0.0));
  EXPECT_EQ(watch.items(at(0.0)).size(), 2u);
  for (int i = 0; i < 500; ++i) watch.heard(SourceKind::imu, Name("imu" + std::to_string(i)), at(0.0));
  EXPECT_EQ(watch.items(at(0.0)).size(), SensorWatch::kMaxSensors);
}

TEST(ServiceWatch, MissingServiceThenRestarted) {
  ServiceWatch watch({{"fusion", Severity::critical}}, {}, 15.0, at(0.0));
  AlarmBook book;
  const auto step = [&](double t) {
    watch.evaluate(at(t));
    watch.report(book, at(t));
  };
  for (double t = 0.0; t < 20.0; t += 1.0) watch.add(life_sign("fusion", t), at(t)), step(t);
  step(21.9);
  EXPECT_EQ(book.all().size(), 0u);
  step(22.1);
  ASSERT_TRUE(alarmed(book, "service_missing:fusion"));
  EXPECT_EQ(book.find("service_missing:fusion")->severity, Severity::critical);
  for (double t = 30.0; t < 35.0; t += 1.0) {
    watch.add(life_sign("fusion", t, ServiceState::healthy, 200), at(t));
    step(t);
  }
  EXPECT_FALSE(alarmed(book, "service_missing:fusion"));
  ASSERT_NE(book.find("service_restarted:fusion"), nullptr);
  EXPECT_FALSE(book.find("service_restarted:fusion")->active);
  EXPECT_NE(book.find("service_restarted:fusion")->text.find("200"), std::string::npos);
}

TEST(ServiceWatch, ARestartTooFastToBeMissedIsStillNoticed) {
  ServiceWatch watch({{"fusion"}}, {}, 15.0, at(0.0));
  AlarmBook book;
  watch.add(life_sign("fusion", 0.0), at(0.0));
  watch.add(life_sign("fusion", 1.0, ServiceState::healthy, 101), at(1.0));
  watch.evaluate(at(1.0));
  watch.report(book, at(1.0));
  EXPECT_NE(book.find("service_restarted:fusion"), nullptr);
  EXPECT_EQ(book.find("service_missing:fusion"), nullptr);
}

TEST(ServiceWatch, DegradedOnlyWhenItLasts) {
  ServiceWatch watch({{"dvl_bridge"}}, {}, 15.0, at(0.0));
  AlarmBook book;
  for (int i = 0; i < 60; ++i) {  // two seconds bad, two seconds good
    const bool bad = i % 4 < 2;
    watch.add(life_sign("dvl_bridge", i, bad ? ServiceState::degraded : ServiceState::healthy), at(i));
    watch.report(book, at(i));
  }
  EXPECT_EQ(book.all().size(), 0u);
  ServiceStatus status = life_sign("dvl_bridge", 60, ServiceState::degraded);
  status.text = "the source is silent";
  for (int i = 60; i < 70; ++i) watch.add(status, at(i)), watch.report(book, at(i));
  ASSERT_TRUE(alarmed(book, "service_unwell:dvl_bridge"));
  EXPECT_NE(book.find("service_unwell:dvl_bridge")->text.find("the source is silent"), std::string::npos);
}

TEST(ServiceWatch, WhatAServiceSaysOfItselfIsAnAlarmThoughNobodyExpectsIt) {
  ServiceWatch watch({{"fusion"}}, {}, 15.0, at(0.0));
  AlarmBook book;
  ServiceStatus status = life_sign("recorder", 0, ServiceState::degraded);
  status.text = "nothing is recorded: No space left on device";
  const auto step = [&](int i, bool heard) {
    watch.add(life_sign("fusion", i), at(i));
    if (heard) watch.add(status, at(i));
    watch.evaluate(at(i));
    watch.report(book, at(i));
  };
  for (int i = 0; i < 10; ++i) step(i, true);
  ASSERT_TRUE(alarmed(book, "service_unwell:recorder"));
  EXPECT_NE(book.find("service_unwell:recorder")->text.find("No space left on device"), std::string::npos);
  status.state = ServiceState::healthy;
  for (int i = 10; i < 15; ++i) step(i, true);
  EXPECT_FALSE(alarmed(book, "service_unwell:recorder"));
  status.state = ServiceState::degraded;
  for (int i = 15; i < 25; ++i) step(i, true);
  ASSERT_TRUE(alarmed(book, "service_unwell:recorder"));
  for (int i = 25; i < 35; ++i) step(i, false);
  EXPECT_FALSE(alarmed(book, "service_unwell:recorder")) << "it is gone, and nobody expects it";
  EXPECT_EQ(book.find("service_missing:recorder"), nullptr);
  status.pid += 1;
  step(35, true);
  EXPECT_EQ(book.find("service_restarted:recorder"), nullptr);
}

TEST(ServiceWatch, AnAlarmThatEndsKeepsWhatBeganIt) {
  ServiceWatch watch({{"gps_bridge"}}, {}, 15.0, at(0.0));
  AlarmBook book;
  ServiceStatus status = life_sign("gps_bridge", 0, ServiceState::degraded);
  const auto say = [&](int i, const std::string& text) {
    status.text = text;
    watch.add(status, at(i));
    watch.evaluate(at(i));
    watch.report(book, at(i));
  };
  for (int i = 0; i < 17; ++i) say(i, "gps: no usable sample for " + std::to_string(i) + ".5 s");
  EXPECT_NE(book.find("service_unwell:gps_bridge")->text.find("sample for 16.5 s."), std::string::npos)
      << "its numbers are the last ones: " << book.find("service_unwell:gps_bridge")->text;
  for (int i = 17; i < 20; ++i) say(i, "gps: slow: 1.75 Hz");
  status.state = ServiceState::healthy;
  say(20, "");
  say(21, "");
  ASSERT_FALSE(alarmed(book, "service_unwell:gps_bridge"));
  EXPECT_NE(book.find("service_unwell:gps_bridge")
                ->text.find("gps: no usable sample for 16.5 s, then gps: slow: 1.75 Hz."),
            std::string::npos)
      << book.find("service_unwell:gps_bridge")->text;
}

TEST(ServiceWatch, AnOrderlyEndIsSaidToBeOne) {
  ServiceWatch watch({{"fusion"}}, {}, 15.0, at(0.0));
  AlarmBook book;
  watch.add(life_sign("fusion", 0.0), at(0.0));
  watch.add(life_sign("fusion", 0.5, ServiceState::stopping), at(0.5));
  watch.evaluate(at(5.0));
  watch.report(book, at(5.0));
  ASSERT_TRUE(alarmed(book, "service_missing:fusion"));
  EXPECT_NE(book.find("service_missing:fusion")->text.find("had announced its end"), std::string::npos);
}

class NavWatchTest : public ::testing::Test {
 protected:
  void run(double from_s, double to_s, const NavState& like, double rate_hz = 100.0) {
    for (int i = 0; i < static_cast<int>((to_s - from_s) * rate_hz); ++i) {
      const double t = from_s + i / rate_hz;
      NavState state = like;
      state.header = header("fusion", t);
      watch.add(state, at(t));
      if (i % 5 == 0) step(t);
    }
  }
  void step(double t) {
    watch.evaluate(at(t));
    watch.report(book, at(t));
  }
  NavWatch watch{NavWatchConfig{}, 15.0, at(0.0)};
  AlarmBook book;
};

TEST_F(NavWatchTest, MissingStateIsCriticalAndTheModeIsThenNone) {
  run(0.0, 10.0, nav(0.0));
  EXPECT_EQ(watch.mode(), NavMode::gps_aided);
  EXPECT_TRUE(watch.fresh());
  step(10.5);
  EXPECT_FALSE(alarmed(book, "nav_state_missing"));
  step(11.1);
  ASSERT_TRUE(alarmed(book, "nav_state_missing"));
  EXPECT_EQ(book.find("nav_state_missing")->severity, Severity::critical);
  EXPECT_EQ(watch.mode(), NavMode::none);
  run(20.0, 22.0, nav(0.0));
  EXPECT_FALSE(alarmed(book, "nav_state_missing"));
}

TEST_F(NavWatchTest, AStateThatRepeatsItselfIsNoSignOfLife) {
  run(0.0, 5.0, nav(0.0));
  for (double t = 5.0; t < 10.0; t += 0.01) watch.add(nav(4.99), at(t));
  step(10.0);
  EXPECT_TRUE(alarmed(book, "nav_state_missing"));
}

TEST_F(NavWatchTest, NeverHeardIsAnAlarmAfterTheStart) {
  step(14.0);
  EXPECT_FALSE(alarmed(book, "nav_state_missing"));
  step(16.0);
  EXPECT_TRUE(alarmed(book, "nav_state_missing"));
}

TEST_F(NavWatchTest, InvalidAndUncertainStates) {
  NavState bad = nav(0.0);
  bad.velocity_N_m_s[1] = kUnknown;
  run(0.0, 2.0, bad);
  EXPECT_TRUE(alarmed(book, "nav_state_invalid"));
  NavState aligning = bad;
  aligning.mode = NavMode::aligning;
  run(2.0, 4.0, aligning);
  EXPECT_FALSE(alarmed(book, "nav_state_invalid")) << "nothing is claimed";
  run(4.0, 6.0, nav(0.0, NavMode::dead_reckoning, AlignmentPhase::aligned, 45.0));
  EXPECT_TRUE(alarmed(book, "nav_uncertain"));
  run(6.0, 8.0, nav(0.0, NavMode::dead_reckoning, AlignmentPhase::aligned, 39.0));
  EXPECT_TRUE(alarmed(book, "nav_uncertain")) << "95.6 m: not yet 10 % below the limit";
  run(8.0, 10.0, nav(0.0));
  EXPECT_FALSE(alarmed(book, "nav_uncertain"));
}

TEST_F(NavWatchTest, SlowState) {
  run(0.0, 12.0, nav(0.0), 40.0);
  EXPECT_TRUE(alarmed(book, "nav_state_slow"));
}

TEST(Uncertainty, RadiusOfALineACircleAndTheUnknown) {
  EXPECT_NEAR(horizontal_95_m({4, 0, 0, 0, 4, 0, 0, 0, 1}), 2.0 * 2.4477, 0.01);
  EXPECT_NEAR(horizontal_95_m({9, 0, 0, 0, 0, 0, 0, 0, 1}), 3.0 * 1.95996, 0.01);
  const double rotated =
      horizontal_95_m({2.5, 1.5, 0, 1.5, 2.5, 0, 0, 0, 1});  // axes 2 and 1, turned by 45 deg
  EXPECT_NEAR(rotated, horizontal_95_m({4, 0, 0, 0, 1, 0, 0, 0, 1}), 1e-9);
  EXPECT_TRUE(std::isnan(horizontal_95_m({-1, 0, 0, 0, 4, 0, 0, 0, 1})));
  EXPECT_TRUE(std::isnan(horizontal_95_m(NavState{}.position_covariance_N_m2)));
  EXPECT_NEAR(vertical_95_m({1, 0, 0, 0, 1, 0, 0, 0, 4}), 3.92, 0.001);
}

}  // namespace
}  // namespace fathom::health
