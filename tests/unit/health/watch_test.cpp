#include <string>

#include <gtest/gtest.h>

#include "health/gps/dispute_watch.hpp"
#include "health/instruments/refusal_watch.hpp"
#include "health/instruments/sensor_watch.hpp"
#include "health/navigation/alignment_watch.hpp"
#include "health/navigation/nav_watch.hpp"
#include "health/writers/service_watch.hpp"
#include "samples/uncertainty.hpp"
#include "timeline.hpp"

namespace fathom::health {
namespace {

bool alarmed(const AlarmBook& book, const Name& key) {
  const Alarm* alarm = book.find(key);
  return alarm != nullptr && alarm->active;
}

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

/// With one condition.
AlignmentStatus alignment(AlignmentPhase phase, const char* name, double value, double limit,
                          bool met = false) {
  AlignmentStatus status;
  status.phase = phase;
  status.condition_count = 1;
  status.conditions[0] = {.name = name, .value = value, .limit = limit, .met = met};
  return status;
}

TEST(AlignmentWatch, TooLongTimedOutLostAndRegained) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  AlignmentStatus status = alignment(AlignmentPhase::waiting, "pitch_rad", 0.4, 0.1);
  for (double t = 0.0; t < 180.0; t += 1.0) watch.add(status, at(t)), watch.report(book, at(t));
  EXPECT_EQ(book.all().size(), 0u);
  for (double t = 180.0; t < 190.0; t += 1.0) watch.add(status, at(t)), watch.report(book, at(t));
  ASSERT_TRUE(alarmed(book, "not_aligned"));
  EXPECT_NE(book.find("not_aligned")->text.find("pitch_rad: 0.4"), std::string::npos)
      << book.find("not_aligned")->text;
  status.phase = AlignmentPhase::aligned;
  for (double t = 190.0; t < 195.0; t += 1.0) watch.add(status, at(t)), watch.report(book, at(t));
  EXPECT_FALSE(alarmed(book, "not_aligned"));
  status.phase = AlignmentPhase::lost;
  watch.add(status, at(195.0));
  watch.report(book, at(195.0));
  ASSERT_TRUE(alarmed(book, "alignment_lost"));
  EXPECT_EQ(book.find("alignment_lost")->severity, Severity::critical);
  status.phase = AlignmentPhase::aligned;
  watch.add(status, at(196.0));
  watch.report(book, at(196.0));
  watch.report(book, at(197.9));
  EXPECT_TRUE(alarmed(book, "alignment_lost"));
  watch.report(book, at(198.1));
  EXPECT_FALSE(alarmed(book, "alignment_lost"));
}

TEST(AlignmentWatch, WhatCannotBeRightIsAnAlarmWithTheAdviceUntilItIsPutRight) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  AlignmentStatus status;
  status.phase = AlignmentPhase::fine;
  status.condition_count = 2;
  status.conditions[0].name = "yaw_sigma_rad";
  status.conditions[0].met = true;
  status.conditions[1].name = "implausible_dvl_unit";
  status.conditions[1].value = 0.001;
  std::snprintf(status.advice.data(), status.advice.size(), "%s", "DVL velocity is not in m/s.");
  watch.add(status, at(1.0));
  watch.report(book, at(1.0));
  ASSERT_TRUE(alarmed(book, "implausible"));
  EXPECT_EQ(book.find("implausible")->severity, Severity::critical);
  EXPECT_EQ(book.find("implausible")->text, "DVL velocity is not in m/s.");
  EXPECT_EQ(book.find("implausible")->value, 0.001);
  status.condition_count = 1;
  watch.add(status, at(2.0));
  for (double t = 2.0; t < 60.0; t += 1.0) watch.report(book, at(t));
  EXPECT_FALSE(alarmed(book, "implausible"));
}

TEST(AlignmentWatch, WhatScattersMoreThanIsSaidIsANoticeUntilItDoesNot) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  AlignmentStatus status = alignment(AlignmentPhase::aligned, "noise_of_dvl0", 6.5, 30.0, true);
  watch.add(status, at(1.0));
  watch.report(book, at(1.0));
  ASSERT_TRUE(alarmed(book, "noisy:dvl0"));
  EXPECT_EQ(book.find("noisy:dvl0")->severity, Severity::notice);
  EXPECT_EQ(book.find("noisy:dvl0")->text,
            "dvl0 scatters 6.5 times as much as its sigmas say. Navigation counts with that.");
  EXPECT_EQ(book.find("noisy:dvl0")->value, 6.5);
  status.condition_count = 0;
  watch.add(status, at(2.0));
  for (double t = 2.0; t < 60.0; t += 1.0) watch.report(book, at(t));
  EXPECT_FALSE(alarmed(book, "noisy:dvl0"));
}

TEST(AlignmentWatch, NoiseOfTheInertialUnitIsToldByTheMotion) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  watch.add(alignment(AlignmentPhase::aligned, "noise_of_gyros", 3.6, 30.0, true), at(1.0));
  watch.report(book, at(1.0));
  ASSERT_TRUE(alarmed(book, "noisy:gyros"));
  EXPECT_EQ(book.find("noisy:gyros")->text,
            "The motion strays as if the noise of the gyros were 3.6 times what is configured. Navigation "
            "counts with that.");
}

TEST(AlignmentWatch, ABiasBeyondItsSigmaIsANoticeOfItsAxis) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  AlignmentStatus status = alignment(AlignmentPhase::aligned, "bias_of_gyro_x", 1.0e-4, 4.85e-6, true);
  status.condition_count = 3;
  status.conditions[1] = {
      .name = "bias_of_accelerometer_z", .value = -0.0980665, .limit = 9.80665e-3, .met = true};
  status.conditions[2] = {.name = "bias_of_anything", .value = 1.0, .limit = 0.1, .met = true};
  watch.add(status, at(1.0));
  watch.report(book, at(1.0));
  ASSERT_TRUE(alarmed(book, "biased:gyro_x"));
  EXPECT_EQ(book.find("biased:gyro_x")->severity, Severity::notice);
  EXPECT_EQ(book.find("biased:gyro_x")->text,
            "The bias of gyro x is 20.6 deg/h, and a sigma of 1 deg/h is configured. Navigation counts with "
            "the bias.");
  ASSERT_TRUE(alarmed(book, "biased:accelerometer_z"));
  EXPECT_EQ(
      book.find("biased:accelerometer_z")->text,
      "The bias of accelerometer z is -10.0 mg, and a sigma of 1 mg is configured. Navigation counts with "
      "the bias.");
  EXPECT_FALSE(alarmed(book, "biased:anything"));
  status.condition_count = 0;
  watch.add(status, at(2.0));
  for (double t = 2.0; t < 60.0; t += 1.0) watch.report(book, at(t));
  EXPECT_FALSE(alarmed(book, "biased:gyro_x"));
}

TEST(AlignmentWatch, WhatIsWaitedForIsNamedWithWhatHelps) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  AlignmentStatus status = alignment(AlignmentPhase::waiting, "yaw_sigma_rad", 0.2, 0.1);
  watch.add(status, at(0.0));
  status.phase = AlignmentPhase::timed_out;
  watch.add(status, at(1.0));
  watch.report(book, at(1.0));
  ASSERT_TRUE(alarmed(book, "not_aligned"));
  EXPECT_NE(book.find("not_aligned")->text.find("turn by 90 degrees"), std::string::npos)
      << book.find("not_aligned")->text;
}

TEST(AlignmentWatch, ALateStatusIsNoLossWhileNavigationStatesCome) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  watch.add(nav(1.0), at(1.0));
  AlignmentStatus old;
  old.phase = AlignmentPhase::fine;
  watch.add(old, at(1.01));
  watch.report(book, at(1.01));
  EXPECT_EQ(watch.phase(), AlignmentPhase::aligned);
  EXPECT_EQ(book.find("alignment_lost"), nullptr);
}

TEST(RefusalWatch, OnlyWhenEverythingIsRefusedForLong) {
  RefusalWatch watch{RefusalWatchConfig{}};
  AlarmBook book;
  double t = 0.0;
  const auto run = [&](double seconds, VerdictKind kind) {
    for (const double end = t + seconds; t < end; t += 0.2) {
      watch.add(verdict(SourceKind::dvl, kind, t, "dvl"), at(t));
      watch.report(book, at(t));
    }
  };
  run(30.0, VerdictKind::out_of_range);
  run(9.0, VerdictKind::rejected);
  run(1.0, VerdictKind::used);
  run(9.0, VerdictKind::rejected);
  EXPECT_EQ(book.all().size(), 0u);
  run(2.0, VerdictKind::frozen);
  ASSERT_TRUE(alarmed(book, "refused:dvl"));
  EXPECT_NE(book.find("refused:dvl")->text.find("frozen"), std::string::npos);
  run(1.0, VerdictKind::used);
  EXPECT_FALSE(alarmed(book, "refused:dvl"));
}

TEST(RefusalWatch, TwoKindsUnderOneNameShareAnAlarm) {
  // A controller's shaft speed is used by the speed log while its fins, which serve the vehicle model alone,
  // are not.
  RefusalWatch watch{RefusalWatchConfig{}};
  AlarmBook book;
  double t = 0.0;
  const auto run = [&](double seconds, VerdictKind fins) {
    std::size_t changes = 0;
    for (const double end = t + seconds; t < end; t += 0.2) {
      watch.add(verdict(SourceKind::propulsion, VerdictKind::used, t, "actuator"), at(t));
      watch.add(verdict(SourceKind::fins, fins, t, "actuator"), at(t));
      watch.report(book, at(t));
      for (const auto& [event, alarm] : book.take_transitions()) changes += alarm.active ? 1 : 0;
    }
    return changes;
  };
  EXPECT_EQ(run(9.0, VerdictKind::rejected), 0u);
  EXPECT_GE(run(3.0, VerdictKind::rejected), 1u);
  EXPECT_TRUE(alarmed(book, "refused:actuator"));
  EXPECT_LE(run(4.0, VerdictKind::rejected), 5u);  // it stays, it does not flicker
  EXPECT_TRUE(alarmed(book, "refused:actuator"));
  run(1.0, VerdictKind::used);
  EXPECT_FALSE(alarmed(book, "refused:actuator"));
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
