#include "status/trust.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace fathom::status {
namespace {

constexpr double kFreshS = 0.7;

StatusView under_way() {
  StatusView view;
  view.nav = Heard<NavState>{{}, 0.01};
  NavState& nav = view.nav->sample;
  nav.mode = NavMode::gps_aided;
  nav.alignment = AlignmentPhase::aligned;
  nav.latitude_rad = 0.6;
  nav.longitude_rad = 2.2;
  nav.position_covariance_N_m2 = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  nav.dvl_outage_s = 0.2;
  nav.gps_outage_s = 0.4;
  view.monitor = Heard<MonitorStatus>{{}, 0.1};
  view.monitor->sample.known = true;
  view.monitor->sample.healthy = true;
  view.monitor->sample.gps_outage_s = 0.0;
  return view;
}

void add_limit(StatusView& view, const char* name, double limit_m, double time_s, const char* without = "") {
  if (!view.forecast) view.forecast = Heard<Forecast>{};
  Forecast& forecast = view.forecast->sample;
  ForecastLimit& limit = forecast.limits.at(forecast.limit_count++);
  limit.name = name;
  limit.limit = limit_m;
  limit.time_to_limit_s = time_s;
  limit.without = without;
}

TEST(Trust, AllIsWell) {
  const Trust trust = judge_trust(under_way(), kFreshS);
  EXPECT_EQ(trust.level, TrustLevel::good);
  EXPECT_EQ(trust.sentence, "GPS with DVL, 95 % 2.5 m");
  EXPECT_EQ(trust.advice, "");
}

TEST(Trust, DeadReckoningSaysSinceWhenAndForHowLong) {
  StatusView view = under_way();
  NavState& nav = view.nav->sample;
  nav.mode = NavMode::dead_reckoning;
  nav.position_covariance_N_m2 = {54, 0, 0, 0, 54, 0, 0, 0, 9};
  view.monitor->sample.gps_outage_active = true;
  view.monitor->sample.gps_outage_severity = Severity::warning;
  view.monitor->sample.gps_outage_s = 252.4;
  add_limit(view, "horizontal_100m", 100.0, 2000.0);
  add_limit(view, "horizontal_50m", 50.0, 660.0);
  add_limit(view, "heading_3deg", 0.05, 10.0);
  add_limit(view, "horizontal_10m", 10.0, 0.0);
  add_limit(view, "horizontal_50m", 50.0, 20.0, "all");
  const Trust trust = judge_trust(view, kFreshS);
  EXPECT_EQ(trust.level, TrustLevel::caution);
  EXPECT_EQ(trust.sentence,
            "Dead reckoning with DVL, GPS gone 4 min 12 s, 95 % 18 m, passes 50 m in about 11 min");
  EXPECT_NE(trust.advice, "");
}

TEST(Trust, WhileGpsIsGoneItIsNotCalledGps) {
  StatusView view = under_way();
  view.monitor->sample.gps_outage_active = true;
  view.monitor->sample.gps_outage_s = 6.0;
  EXPECT_EQ(judge_trust(view, kFreshS).sentence, "Dead reckoning with DVL, GPS gone 6.0 s, 95 % 2.5 m");
}

TEST(Trust, WithoutNavigationNothingElseCounts) {
  EXPECT_EQ(judge_trust({}, kFreshS).sentence, "No navigation: nothing has been heard yet");
  StatusView view = under_way();
  view.nav->age_s = 0.71;
  EXPECT_EQ(judge_trust(view, kFreshS).sentence, "No navigation: the last state came 0.7 s ago");
  EXPECT_EQ(judge_trust(view, kFreshS).level, TrustLevel::bad);
  view.nav->age_s = 0.69;
  EXPECT_EQ(judge_trust(view, kFreshS).level, TrustLevel::good);
}

TEST(Trust, AligningSaysWhatItWaitsFor) {
  StatusView view = under_way();
  view.nav->sample.mode = NavMode::aligning;
  view.alignment = Heard<AlignmentStatus>{};
  view.alignment->sample.phase = AlignmentPhase::averaging;
  view.alignment->sample.in_phase_s = 4.0;
  view.alignment->sample.time_to_aligned_s = 6.0;
  const std::string advice = "Hold still.";
  std::copy(advice.begin(), advice.end(), view.alignment->sample.advice.begin());
  const Trust trust = judge_trust(view, kFreshS);
  EXPECT_EQ(trust.level, TrustLevel::bad);
  EXPECT_EQ(trust.sentence, "No navigation yet: aligning, averaging for 4.0 s, done in about 6 s");
  EXPECT_EQ(trust.advice, advice);
}

TEST(Trust, EveryDoubtLowersIt) {
  struct Case {
    TrustLevel expected;
    const char* words;
    void (*spoil)(StatusView&);
  };
  const Case cases[] = {
      {TrustLevel::bad, "GPS gone",
       [](StatusView& v) {
         v.monitor->sample.gps_outage_active = true;
         v.monitor->sample.gps_outage_s = 4000.0;
         v.monitor->sample.gps_outage_severity = Severity::critical;
       }},
      {TrustLevel::caution, "Inertial alone", [](StatusView& v) { v.nav->sample.mode = NavMode::inertial; }},
      {TrustLevel::caution, "without DVL",
       [](StatusView& v) {
         v.nav->sample.mode = NavMode::dead_reckoning;
         v.nav->sample.dvl_outage_s = 30.0;
         add_limit(v, "horizontal_50m", 50.0, 100.0);
       }},
      {TrustLevel::bad, "95 % unknown",
       [](StatusView& v) { v.nav->sample.position_covariance_N_m2[0] = kUnknown; }},
      {TrustLevel::bad, "No navigation yet", [](StatusView& v) { v.nav->sample.latitude_rad = kUnknown; }},
      {TrustLevel::bad, "alignment lost",
       [](StatusView& v) { v.nav->sample.alignment = AlignmentPhase::lost; }},
      {TrustLevel::caution, "alignment coarse",
       [](StatusView& v) { v.nav->sample.alignment = AlignmentPhase::coarse; }},
      {TrustLevel::caution, "the monitor is silent", [](StatusView& v) { v.monitor.reset(); }},
      {TrustLevel::caution, "the monitor is silent", [](StatusView& v) { v.monitor->age_s = 10.0; }},
      {TrustLevel::caution, "does not know yet", [](StatusView& v) { v.monitor->sample.known = false; }},
      {TrustLevel::caution, "GPS", [](StatusView& v) { v.monitor->sample.healthy = false; }},
  };
  for (const Case& item : cases) {
    StatusView view = under_way();
    item.spoil(view);
    const Trust trust = judge_trust(view, kFreshS);
    EXPECT_EQ(trust.level, item.expected) << trust.sentence;
    EXPECT_NE(trust.sentence.find(item.words), std::string::npos) << trust.sentence;
  }
}

TEST(Trust, ALimitThatIsNeverPassedIsNotMentioned) {
  StatusView view = under_way();
  view.nav->sample.mode = NavMode::acoustic_aided;
  add_limit(view, "horizontal_50m", 50.0, std::numeric_limits<double>::infinity());
  EXPECT_EQ(judge_trust(view, kFreshS).sentence, "USBL with DVL, GPS last used 0.4 s ago, 95 % 2.5 m");
}

/// Under way without GPS for 34 s, beside a receiver that is heard.
StatusView without_gps() {
  StatusView view = under_way();
  view.utc_ns = 0;  // the clock of the monitor counts
  view.nav->sample.mode = NavMode::dead_reckoning;
  MonitorStatus& monitor = view.monitor->sample;
  monitor.header.stamp_ns = 1'700'000'000 * kNsPerSecond;
  monitor.gps_outage_active = true;
  monitor.gps_outage_severity = Severity::warning;
  monitor.gps_outage_s = 34.0;
  monitor.receivers = {{"gps", true, Severity::warning, 0, 34.0, 34.0, 34.0, 1}};
  monitor.sensors = {{"gps", Presence::present, 0.2, 2.0}};
  return view;
}

void add_alarm(StatusView& view, const char* key, double for_s, bool active = true) {
  Alarm alarm;
  alarm.alarm = key;
  alarm.active = active;
  alarm.since_ns = view.monitor->sample.header.stamp_ns - from_seconds(for_s);
  view.alarms[key] = alarm;
}

void add_verdict(StatusView& view, const char* sensor, VerdictKind kind, double refused_for_s) {
  view.verdicts[sensor].last = kind;
  view.verdicts[sensor].last_age_s = 0.2;
  view.verdicts[sensor].refused_for_s = refused_for_s;
}

bool says(const std::string& text, const char* words) {
  return text.find(words) != std::string::npos;
}

TEST(Trust, AReceiverUnderWaterIsWorthSurfacing) {
  StatusView view = without_gps();
  add_verdict(view, "gps", VerdictKind::no_fix, 0.0);
  add_alarm(view, "refused:gps", 60.0);  // of before the dive, it goes soon
  add_alarm(view, "gps_disputed:gps", 60.0, false);
  const Trust trust = judge_trust(view, kFreshS);
  EXPECT_TRUE(says(trust.sentence, "GPS gone 34.0 s")) << trust.sentence;
  EXPECT_TRUE(says(trust.advice, "Surface for GPS")) << trust.advice;
}

TEST(Trust, AFixThatIsRefusedIsNotCalledGoneAndNeedsNoSurface) {
  StatusView at_once = without_gps();
  add_verdict(at_once, "gps", VerdictKind::rejected, 6.5);
  StatusView by_alarm = without_gps();
  add_alarm(by_alarm, "refused:gps", 6.4);
  for (const StatusView& view : {at_once, by_alarm}) {
    const Trust trust = judge_trust(view, kFreshS);
    EXPECT_EQ(trust.level, TrustLevel::caution);
    EXPECT_EQ(trust.sentence,
              "Dead reckoning with DVL, gps has a fix that navigation has refused for 6.5 s, 95 % 2.5 m");
    EXPECT_TRUE(says(trust.advice, "Compare gps with another position")) << trust.advice;
    EXPECT_FALSE(says(trust.advice, "Surface")) << trust.advice;
  }
  StatusView late = without_gps();
  add_verdict(late, "gps", VerdictKind::late, 6.5);
  EXPECT_TRUE(says(judge_trust(late, kFreshS).advice, "Look at the clock behind gps"));
}

TEST(Trust, AFixFarFromNavigationMakesThePositionBad) {
  StatusView view = without_gps();
  add_alarm(view, "gps_disputed:gps", 32.4);
  add_alarm(view, "refused:gps", 32.4);
  add_verdict(view, "gps", VerdictKind::disputed, 2.0);
  view.nav->sample.mode = NavMode::acoustic_aided;
  const Trust trust = judge_trust(view, kFreshS);
  EXPECT_EQ(trust.level, TrustLevel::bad);
  EXPECT_EQ(trust.sentence,
            "USBL with DVL, gps has a fix that navigation has refused for 32.5 s, 95 % 2.5 m");
  EXPECT_EQ(trust.advice,
            "gps or navigation is far wrong: compare with another position, then disable gps or set the "
            "position.");
}

TEST(Trust, AReceiverThatIsNotHeardIsNotWorthSurfacing) {
  for (const Presence presence : {Presence::missing, Presence::stale}) {
    StatusView view = without_gps();
    add_alarm(view, "refused:gps", 60.0);
    view.monitor->sample.sensors = {{"gps", presence, 33.9, 0.0}};
    const Trust trust = judge_trust(view, kFreshS);
    EXPECT_TRUE(says(trust.sentence, ", gps has been silent for 34.0 s, GPS gone 34.0 s")) << trust.sentence;
    EXPECT_EQ(trust.advice,
              "Look at the cable, port and bridge of gps: at the surface it stays silent, too.");
  }
}

TEST(Trust, FrozenAndDisabledReceiversAreNamed) {
  StatusView frozen = without_gps();
  add_alarm(frozen, "gps_frozen:gps", 11.9);
  EXPECT_TRUE(says(judge_trust(frozen, kFreshS).sentence, "gps has repeated one fix for 12.0 s, GPS gone"));
  EXPECT_TRUE(says(judge_trust(frozen, kFreshS).advice, "Restart gps"));
  StatusView disabled = without_gps();
  add_verdict(disabled, "gps", VerdictKind::source_disabled, 0.0);
  EXPECT_TRUE(says(judge_trust(disabled, kFreshS).sentence, "gps is disabled, GPS gone"));
  EXPECT_TRUE(says(judge_trust(disabled, kFreshS).advice, "Enable gps"));
}

TEST(Trust, OfSeveralReceiversTheOneNearestToAFixIsNamed) {
  StatusView view = without_gps();
  MonitorStatus& monitor = view.monitor->sample;
  monitor.receivers.push_back({"bow", true, Severity::warning, 0, 34.0, 34.0, 34.0, 1});
  monitor.sensors.push_back({"bow", Presence::missing, 40.0, 0.0});
  EXPECT_TRUE(says(judge_trust(view, kFreshS).advice, "Surface")) << "gps is only under water";
  add_alarm(view, "refused:gps", 20.0);
  EXPECT_TRUE(says(judge_trust(view, kFreshS).sentence, "gps has a fix"));
  monitor.receivers[0].active = false;
  EXPECT_TRUE(says(judge_trust(view, kFreshS).advice, "bridge of bow")) << "gps does not count";
}

}  // namespace
}  // namespace fathom::status
