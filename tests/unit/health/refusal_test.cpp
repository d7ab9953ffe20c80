#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "health/instruments/refusal_watch.hpp"
#include "timeline.hpp"

namespace fathom::health {
namespace {

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

TEST(RefusalWatch, NavigationThatGoesOnHasUsedInertialSamples) {
  RefusalWatch watch{RefusalWatchConfig{}};
  AlarmBook book;
  const auto run = [&](double from_s, double to_s, double state_every_s) {
    double next_s = from_s;
    for (double t = from_s; t < to_s; t += 0.01) {
      if (t >= next_s) watch.add(nav(t)), next_s += state_every_s;
      const bool fourth = std::llround(t * 100.0) % 4 == 0;
      if (fourth) watch.add(verdict(SourceKind::imu, VerdictKind::late, t, "imu"), at(t));
      watch.add(verdict(SourceKind::dvl, VerdictKind::rejected, t, "dvl"), at(t));
      watch.report(book, at(t));
    }
  };
  run(0.0, 40.0, 0.01);
  EXPECT_FALSE(alarmed(book, "refused:imu")) << book.find("refused:imu")->text;
  EXPECT_TRUE(alarmed(book, "refused:dvl")) << "a state says nothing of what aids it";
  run(40.0, 60.0, 100.0);
  EXPECT_TRUE(alarmed(book, "refused:imu"));
  run(60.0, 62.0, 0.01);
  EXPECT_FALSE(alarmed(book, "refused:imu"));
}

TEST(RefusalWatch, AStateThatRepeatsItselfHasUsedNothing) {
  RefusalWatch watch{RefusalWatchConfig{}};
  AlarmBook book;
  for (double t = 0.0; t < 20.0; t += 0.01) {
    watch.add(nav(0.0));
    watch.add(verdict(SourceKind::imu, VerdictKind::late, t, "imu"), at(t));
    watch.report(book, at(t));
  }
  EXPECT_TRUE(alarmed(book, "refused:imu"));
}

/// How often the alarm of a sensor that is refused every `period_s` is raised within `seconds`.
int raised(RefusalWatch& watch, const Name& sensor, double period_s, double seconds) {
  AlarmBook book;
  int count = 0;
  double next_s = 0.0;
  for (double t = 0.0; t < seconds; t += 0.5) {
    if (t >= next_s) {
      watch.add(verdict(SourceKind::usbl, VerdictKind::rejected, t, sensor), at(t));
      next_s += period_s;
    }
    watch.report(book, at(t));
    const auto transitions = book.take_transitions();
    count += static_cast<int>(std::count_if(transitions.begin(), transitions.end(),
                                            [](const auto& one) { return one.event == AlarmEvent::raised; }));
  }
  return count;
}

TEST(RefusalWatch, ASlowInstrumentThatIsRefusedIsOneAlarm) {
  const std::vector<ExpectedSensor> sensors{{"usbl", SourceKind::usbl, 0.2}};  // missing after 50 s
  for (const double period_s : {1.0, 12.0, 15.0, 30.0}) {
    RefusalWatch watch{RefusalWatchConfig{}, Freshness(sensors, {})};
    EXPECT_EQ(raised(watch, "usbl", period_s, 600.0), 1) << period_s;
  }
}

TEST(RefusalWatch, AnInstrumentThatNobodyExpectsIsJudgedByThePaceOfItsRefusals) {
  for (const double period_s : {15.0, 25.0, 45.0, 120.0}) {
    RefusalWatch watch{RefusalWatchConfig{}};
    EXPECT_EQ(raised(watch, "usbl_x", period_s, 20.0 * period_s), 1) << period_s;
  }
}

TEST(RefusalWatch, ASensorThatFellSilentIsMissingAndNoLongerRefused) {
  RefusalWatch watch{RefusalWatchConfig{}, Freshness({{"usbl", SourceKind::usbl, 0.2}}, {})};
  EXPECT_EQ(raised(watch, "usbl", 12.0, 121.0), 1);  // the last at 120 s
  AlarmBook book;
  watch.report(book, at(169.0));
  EXPECT_TRUE(alarmed(book, "refused:usbl"));
  watch.report(book, at(171.0));
  watch.report(book, at(172.0));
  EXPECT_FALSE(alarmed(book, "refused:usbl"));
}

}  // namespace
}  // namespace fathom::health
