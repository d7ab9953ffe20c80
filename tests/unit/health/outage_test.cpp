#include <vector>

#include <gtest/gtest.h>

#include "health/gps/gps_outage.hpp"
#include "health/gps/outage_clock.hpp"
#include "timeline.hpp"

namespace fathom::health {
namespace {

constexpr double kTick = 0.1;

/// Fixes at `rate_hz` whose usability `usable` decides, evaluated every 0.1 s.
class Reception {
 public:
  explicit Reception(const OutageLimits& limits = {}) : clock_(limits) {}
  void until(double end_s, bool fixes, double period_s = 0.5) {
    for (; now_s_ < end_s - 1e-9; now_s_ += kTick) {
      if (now_s_ >= next_fix_s_ - 1e-9) {
        if (fixes) clock_.usable(at(now_s_).monotonic_ns);
        next_fix_s_ = now_s_ + period_s;
      }
      clock_.evaluate(at(now_s_).monotonic_ns);
    }
    if (!fixes) next_fix_s_ = now_s_;
  }
  void fix() { clock_.usable(at(now_s_).monotonic_ns); }
  OutageClock& clock() { return clock_; }
  [[nodiscard]] double now_s() const { return now_s_; }

 private:
  OutageClock clock_;
  double now_s_ = 0.0;
  double next_fix_s_ = 0.0;
};

TEST(OutageClock, UnknownBeforeTheFirstFixThenNone) {
  Reception run;
  run.until(60.0, false);
  EXPECT_TRUE(std::isnan(run.clock().now_s()));
  EXPECT_FALSE(run.clock().active());
  EXPECT_EQ(run.clock().count(), 0u);
  run.until(61.0, true);
  EXPECT_EQ(run.clock().now_s(), 0.0);
}

TEST(OutageClock, BeginsAtTheLimitAndCountsFromTheLastFix) {
  Reception run;
  run.until(10.05, true);  // the last fix at 10.0
  run.until(14.95, false);
  EXPECT_FALSE(run.clock().active());
  run.until(15.15, false);
  EXPECT_TRUE(run.clock().active());
  EXPECT_NEAR(run.clock().now_s(), 5.1, 0.11);
  run.until(40.05, false);
  EXPECT_NEAR(run.clock().now_s(), 30.0, 0.11);
  EXPECT_NEAR(run.clock().longest_s(), 30.0, 0.11);
  EXPECT_NEAR(run.clock().total_s(), 30.0, 0.11);
  EXPECT_EQ(run.clock().count(), 1u);
}

TEST(OutageClock, EndsAfterARunOfFixesAndIsAsLongAsTheGapWas) {
  Reception run;
  run.until(10.05, true);
  run.until(29.95, false);
  run.until(30.95, true);  // 30.0, 30.5: two fixes over half a second
  EXPECT_TRUE(run.clock().active());
  EXPECT_NEAR(run.clock().now_s(), 20.0, 0.11) << "stands still while a run is under way";
  run.until(31.15, true);  // 31.0: the third, one second after the first
  EXPECT_FALSE(run.clock().active());
  EXPECT_EQ(run.clock().now_s(), 0.0);
  EXPECT_NEAR(run.clock().longest_s(), 20.0, 0.11);
  EXPECT_NEAR(run.clock().total_s(), 20.0, 0.11);
  run.until(60.0, true);
  EXPECT_EQ(run.clock().count(), 1u);
}

TEST(OutageClock, SingleFixesInsideAnOutageNeitherEndNorSplitIt) {
  Reception run;
  run.until(10.05, true);
  run.until(30.0, false);
  for (double next = 30.0; next < 100.0; next += 7.0) {
    run.until(next, false);
    run.fix();
    EXPECT_TRUE(run.clock().active());
  }
  run.until(110.0, false);
  EXPECT_TRUE(run.clock().active());
  EXPECT_EQ(run.clock().count(), 1u);
  EXPECT_NEAR(run.clock().now_s(), 100.0, 0.2);
}

TEST(OutageClock, LongestNeverShrinks) {
  Reception run;
  double longest = 0.0;
  for (int cycle = 0; cycle < 5; ++cycle) {
    const double begin = 40.0 * cycle;
    for (double t = begin; t < begin + 40.0; t += 0.5) {
      run.until(t, t - begin < 15.0);
      EXPECT_GE(run.clock().longest_s(), longest);
      longest = run.clock().longest_s();
    }
  }
  EXPECT_GE(run.clock().count(), 4u);
}

TEST(OutageClock, ReceptionAtTheEdgeOfTheLimitDoesNotFlap) {
  // A fix every 4.9 s: never an outage. Every 5.2 s: one outage that goes on, since no run is long enough.
  Reception good;
  good.until(300.0, true, 4.9);
  EXPECT_EQ(good.clock().count(), 0u);
  Reception poor;
  poor.until(300.0, true, 5.2);
  EXPECT_EQ(poor.clock().count(), 1u);
  EXPECT_TRUE(poor.clock().active());
}

TEST(OutageClock, AnUnusableFixBreaksTheRun) {
  Reception run;
  run.until(10.05, true);
  run.until(20.0, false);
  for (int i = 0; i < 20; ++i) {  // usable, usable, unusable, ...
    run.until(20.5 + 0.5 * i, false);
    if (i % 3 == 2) {
      run.clock().unusable();
    } else {
      run.fix();
    }
  }
  EXPECT_TRUE(run.clock().active());
  EXPECT_EQ(run.clock().count(), 1u);
}

TEST(OutageClock, NoticesAnOutageThatNobodyEvaluated) {
  OutageClock clock;
  clock.usable(at(0.0).monotonic_ns);
  clock.usable(at(30.0).monotonic_ns);  // the monitor was held up in between
  EXPECT_TRUE(clock.active());
  EXPECT_EQ(clock.count(), 1u);
  EXPECT_NEAR(clock.longest_s(), 30.0, 1e-9);
}

TEST(GpsFixRule, ThreeDimensionalAndFinite) {
  GpsSample sample = gps(0.0);
  EXPECT_TRUE(is_usable(sample));
  for (const GpsFix fix : {GpsFix::none, GpsFix::time_only, GpsFix::dead_reckoning, GpsFix::fix_2d}) {
    sample.fix = fix;
    EXPECT_FALSE(is_usable(sample));
  }
  for (const GpsFix fix : {GpsFix::differential, GpsFix::rtk_float, GpsFix::rtk_fixed}) {
    sample.fix = fix;
    EXPECT_TRUE(is_usable(sample));
  }
  sample.latitude_rad = kUnknown;
  EXPECT_FALSE(is_usable(sample));
  sample.latitude_rad = 2.0;
  EXPECT_FALSE(is_usable(sample));
  sample.latitude_rad = 0.5;
  sample.longitude_rad = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_usable(sample));
}

class GpsOutageTest : public ::testing::Test {
 protected:
  void step(double t) {
    outage.evaluate(at(t));
    outage.report(book, at(t));
  }
  [[nodiscard]] bool alarmed(const Name& key) const {
    const Alarm* alarm = book.find(key);
    return alarm != nullptr && alarm->active;
  }
  GpsOutageConfig config;
  GpsOutage outage{config, at(0.0)};
  AlarmBook book{"auv"};
};

TEST_F(GpsOutageTest, AlarmIsFlaggedWithinATickOfTheLimitAndSaysHowLong) {
  for (double t = 0.0; t < 20.0; t += 0.5) outage.add(gps(t), at(t)), step(t);  // last fix at 19.5
  double flagged = 0.0;
  for (double t = 20.0; t < 60.0; t += 0.05) {
    if (static_cast<int>(t * 20.0) % 10 == 0) outage.add(gps(t, false), at(t));
    step(t);
    if (flagged == 0.0 && alarmed("gps_outage")) flagged = t;
  }
  EXPECT_NEAR(flagged, 24.5, 0.06);
  const Alarm* alarm = book.find("gps_outage");
  ASSERT_NE(alarm, nullptr);
  EXPECT_EQ(alarm->severity, Severity::warning) << "longer than 30 s";
  EXPECT_NEAR(to_seconds(alarm->since_ns - kEpoch), 19.5, 0.01);
  EXPECT_NEAR(alarm->value, 40.5, 0.1);
  EXPECT_EQ(alarm->limit, 5.0);
  EXPECT_NE(alarm->text.find("40."), std::string::npos) << alarm->text;
}

TEST_F(GpsOutageTest, ItsSeverityGrowsWithItsLength) {
  outage.add(gps(0.0), at(0.0));
  for (double t = 0.0; t < 29.9; t += 0.5) step(t);
  EXPECT_EQ(book.find("gps_outage")->severity, Severity::notice);
  step(30.5);
  EXPECT_EQ(book.find("gps_outage")->severity, Severity::warning);
  step(3600.5);
  EXPECT_EQ(book.find("gps_outage")->severity, Severity::critical);
}

Forecast forecast(double time_to_limit_s) {
  Forecast out;
  out.limit_count = 2;
  out.limits[0] = {"horizontal_10m", 10.0, 1.0, 0.1};  // passed soon, and not what outages are graded by
  out.limits[1] = {"horizontal_100m", 100.0, 1.0, time_to_limit_s};
  return out;
}

TEST_F(GpsOutageTest, AForecastMakesItSevereSoonerAndOnlyWhenItPersists) {
  outage.add(gps(0.0), at(0.0));
  for (double t = 0.0; t < 10.0; t += 0.5) {
    outage.add(forecast(t == 7.0 ? 10.0 : 90.0), at(t));  // one forecast that stands alone
    step(t);
  }
  EXPECT_EQ(book.find("gps_outage")->severity, Severity::notice);
  for (double t = 10.0; t < 12.5; t += 0.5) outage.add(forecast(50.0), at(t)), step(t);
  EXPECT_EQ(book.find("gps_outage")->severity, Severity::warning);
  for (double t = 12.5; t < 15.0; t += 0.5) outage.add(forecast(14.0), at(t)), step(t);
  EXPECT_EQ(book.find("gps_outage")->severity, Severity::critical);
  EXPECT_NE(book.find("gps_outage")->text.find("horizontal_100m is forecast in 14.0 s"), std::string::npos)
      << book.find("gps_outage")->text;
  for (double t = 15.0; t < 20.0; t += 0.5) outage.add(forecast(90.0), at(t)), step(t);
  EXPECT_EQ(book.find("gps_outage")->severity, Severity::critical) << "a grade does not fall while it lasts";
  EXPECT_EQ(outage.vehicle(at(20.0)).severity, Severity::critical);
}

TEST_F(GpsOutageTest, AForecastOfADeadFusionCountsNoLonger) {
  outage.add(gps(0.0), at(0.0));
  outage.add(forecast(14.0), at(0.0));  // and no more
  for (double t = 0.0; t < 29.0; t += 0.5) step(t);
  EXPECT_EQ(book.find("gps_outage")->severity, Severity::notice);
}

TEST_F(GpsOutageTest, ForecastsWithoutAnOutageRaiseNothing) {
  for (double t = 0.0; t < 60.0; t += 0.5) {
    outage.add(gps(t), at(t));
    outage.add(forecast(3.0), at(t));
    step(t);
  }
  EXPECT_EQ(book.find("gps_outage"), nullptr);
}

TEST_F(GpsOutageTest, BooksAreKeptPerReceiver) {
  for (double t = 0.0; t < 10.0; t += 0.5) {
    outage.add(gps(t, true, "bow"), at(t));
    outage.add(gps(t, true, "stern"), at(t));
    step(t);
  }
  for (double t = 10.0; t < 50.0; t += 0.5) {
    outage.add(gps(t, t >= 20.0, "bow"), at(t));
    outage.add(gps(t, false, "stern"), at(t));
    step(t);
  }
  const auto receivers = outage.receivers(at(49.5));
  ASSERT_EQ(receivers.size(), 2u);
  EXPECT_EQ(receivers[0].name, Name("bow"));
  EXPECT_FALSE(receivers[0].active);
  EXPECT_EQ(receivers[0].since_ns, 0);
  EXPECT_EQ(receivers[0].outage_s, 0.0);
  EXPECT_NEAR(receivers[0].longest_s, 10.5, 0.01);
  EXPECT_NEAR(receivers[0].total_s, 10.5, 0.01);
  EXPECT_EQ(receivers[0].count, 1u);
  EXPECT_TRUE(receivers[1].active);
  EXPECT_NEAR(to_seconds(receivers[1].since_ns - kEpoch), 9.5, 0.01);
  EXPECT_NEAR(receivers[1].outage_s, 40.0, 0.01);
  EXPECT_EQ(receivers[1].severity, Severity::warning);
  EXPECT_NEAR(outage.vehicle(at(49.5)).longest_s, 10.5, 0.01)
      << "the vehicle had no fix only while neither had";
}

TEST_F(GpsOutageTest, FixesDoubtedAfterTheFactNeverWere) {
  for (double t = 0.0; t < 20.0; t += 0.5) outage.add(gps(t), at(t)), step(t);
  EXPECT_FALSE(alarmed("gps_outage"));
  outage.doubt("gps", at(10.0).monotonic_ns);
  step(20.0);
  EXPECT_TRUE(alarmed("gps_outage"));
  EXPECT_NEAR(outage.overall().now_s(), 10.0, 0.01);
}

TEST_F(GpsOutageTest, DoubtInOneReceiverLeavesTheOthersFixes) {
  for (double t = 0.0; t < 20.0; t += 0.5) {
    outage.add(gps(t, true, "bow"), at(t));
    outage.add(gps(t, true, "stern"), at(t));
    step(t);
  }
  outage.doubt("stern", at(5.0).monotonic_ns);
  step(20.0);
  EXPECT_FALSE(alarmed("gps_outage"));
  EXPECT_TRUE(alarmed("gps_outage:stern"));
}

TEST_F(GpsOutageTest, NoFirstFixIsItsOwnAlarm) {
  for (double t = 0.0; t < 119.0; t += 1.0) outage.add(gps(t, false), at(t)), step(t);
  EXPECT_FALSE(alarmed("gps_no_fix"));
  step(121.0);
  EXPECT_TRUE(alarmed("gps_no_fix"));
  EXPECT_FALSE(alarmed("gps_outage"));
  outage.add(gps(122.0), at(122.0));
  step(122.0);
  step(123.0);
  EXPECT_FALSE(alarmed("gps_no_fix"));
}

TEST_F(GpsOutageTest, RepeatedStampIsNoNewFix) {
  for (double t = 0.0; t < 20.0; t += 0.5) outage.add(gps(3.0), at(t)), step(t);
  EXPECT_TRUE(alarmed("gps_outage")) << "the same fix again and again";
}

TEST_F(GpsOutageTest, AStepOfUtcNeitherBeginsNorHidesAnOutage) {
  for (double t = 0.0; t < 20.0; t += 0.5) {
    const double step_s = t < 10.0 ? 0.0 : -3600.0;  // stamps jump back with the clock
    outage.add(gps(t + step_s), at(t, step_s));
    outage.evaluate(at(t, step_s));
    EXPECT_FALSE(outage.overall().active());
  }
  for (double t = 20.0; t < 30.0; t += 0.5) outage.evaluate(at(t, t < 22.0 ? -3600.0 : 7200.0));
  EXPECT_TRUE(outage.overall().active());
  EXPECT_NEAR(outage.overall().now_s(), 10.0, 0.01);
}

TEST_F(GpsOutageTest, FixesThatFusionRefusesDoNotEndTheOutage) {
  for (double t = 0.0; t < 10.0; t += 0.5) outage.add(gps(t), at(t)), step(t);
  for (double t = 10.0; t < 20.0; t += 0.5) outage.add(gps(t, false), at(t)), step(t);
  ASSERT_TRUE(alarmed("gps_outage"));
  for (double t = 20.0; t < 40.0; t += 0.5) {
    outage.add(gps(t), at(t));
    outage.add(verdict(SourceKind::gps, VerdictKind::rejected, t, "gps"));
    step(t);
  }
  EXPECT_TRUE(alarmed("gps_outage"));
  double cleared = 0.0;
  for (double t = 40.0; t < 45.0; t += 0.5) {
    outage.add(gps(t), at(t));
    outage.add(verdict(SourceKind::gps, VerdictKind::used, t, "gps"));
    step(t);
    if (cleared == 0.0 && !alarmed("gps_outage")) cleared = t;
  }
  EXPECT_NEAR(cleared, 41.0, 0.01);
  EXPECT_NEAR(outage.overall().longest_s(), 30.5, 0.01)
      << "from the last fix believed to the first believed again";
}

TEST_F(GpsOutageTest, WorksWithoutAnyVerdictWhenFusionIsDead) {
  for (double t = 0.0; t < 10.0; t += 0.5) outage.add(gps(t), at(t)), step(t);
  for (double t = 10.0; t < 20.0; t += 0.5) step(t);
  EXPECT_TRUE(alarmed("gps_outage"));
  for (double t = 20.0; t < 22.0; t += 0.5) outage.add(gps(t), at(t)), step(t);
  EXPECT_FALSE(alarmed("gps_outage"));
}

TEST_F(GpsOutageTest, TwoReceiversAreKeptApartAndOneFixIsEnoughForTheVehicle) {
  for (double t = 0.0; t < 10.0; t += 0.5) {
    outage.add(gps(t, true, "bow"), at(t));
    outage.add(gps(t, true, "stern"), at(t));
    step(t);
  }
  for (double t = 10.0; t < 30.0; t += 0.5) {
    outage.add(gps(t, true, "bow"), at(t));
    outage.add(gps(t, false, "stern"), at(t));
    step(t);
  }
  EXPECT_FALSE(alarmed("gps_outage"));
  EXPECT_FALSE(alarmed("gps_outage:bow"));
  EXPECT_TRUE(alarmed("gps_outage:stern"));
  EXPECT_NEAR(outage.receiver("stern")->now_s(), 20.0, 0.01);
  EXPECT_EQ(outage.receiver("port"), nullptr);
  // Both lost, then bow back while stern still says "no fix".
  for (double t = 30.0; t < 40.0; t += 0.5) step(t);
  EXPECT_TRUE(alarmed("gps_outage"));
  for (double t = 40.0; t < 42.0; t += 0.5) {
    outage.add(gps(t, true, "bow"), at(t));
    outage.add(gps(t, false, "stern"), at(t));
    step(t);
  }
  EXPECT_FALSE(alarmed("gps_outage"));
}

TEST_F(GpsOutageTest, FloodOfReceiverNamesIsBounded) {
  for (int i = 0; i < 1000; ++i) {
    outage.add(gps(i, true, Name("gps" + std::to_string(i))), at(0.0));
  }
  EXPECT_NE(outage.receiver("gps0"), nullptr);
  EXPECT_EQ(outage.receiver("gps999"), nullptr);
}

}  // namespace
}  // namespace fathom::health
