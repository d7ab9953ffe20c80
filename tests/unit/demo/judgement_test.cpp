// What the demonstration makes of a run: observations go in, the verdict comes out.

#include "demo/judgement.hpp"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "demo/report.hpp"
#include "demo/run_record.hpp"

namespace fathom::demo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr TimeNs kBeganNs = 1'700'000'000 * kNsPerSecond;
constexpr double kRunS = 60.0;
constexpr double kAlignedS = 10.0;

TimeNs at(double t_s) {
  return kBeganNs + from_seconds(t_s);
}

/// A run of a minute with one GPS outage from 20 s to 40 s in which everything goes well; a test takes from
/// it what shall go wrong.
class Voyage {
 public:
  Voyage() {
    demands_.limits.horizontal_rms_m = 5.0;
    demands_.limits.aligned_within_s = 15.0;
    demands_.limits.gps_outages_at_least = 1;
    demands_.services = {"fusion", "monitor"};
    demands_.expected_alarms = {"gps_outage*"};
  }

  struct Span {
    double from_s = 0.0;
    double to_s = 0.0;
    [[nodiscard]] bool has(double t_s) const { return t_s >= from_s && t_s < to_s; }
  };
  Span no_states, lost, not_finite, mute_fusion, mute_monitor;
  Span gps_gone{20.0, 40.0};
  Span flag{25.1, 41.0};  ///< of the monitor
  double nav_starts_s = 0.5;
  double ends_s = kRunS;
  std::vector<double> lone_fixes_s;
  int copies = 1;  ///< of each navigation state
  bool falls = false;
  std::vector<Alarm> alarms;

  Demands& demands() { return demands_; }

  [[nodiscard]] Observation observed() const {
    RunRecord record({.score_from_s = 0.0}, kBeganNs);
    constexpr double kStepS = 0.01;
    for (int i = 0; i * kStepS < ends_s; ++i) {
      const double t_s = i * kStepS;
      if (t_s >= nav_starts_s && !no_states.has(t_s)) {
        for (int copy = 0; copy < copies; ++copy) record.add(state(t_s), 300.0);
      }
      if (i % 10 == 0) record.add(truth(t_s));
      const bool lone = std::any_of(lone_fixes_s.begin(), lone_fixes_s.end(),
                                    [t_s](double fix_s) { return std::abs(fix_s - t_s) < 1e-6; });
      if (lone || (i % 50 == 0 && !gps_gone.has(t_s))) record.add(fix(t_s));
      if (i % 20 == 0 && !mute_monitor.has(t_s)) record.add(monitor(t_s));
      if (i % 100 != 0) continue;
      if (!mute_fusion.has(t_s))
        record.add(life_sign("fusion", falls && t_s > 30.0), from_seconds(t_s + 5.0));
      if (!mute_monitor.has(t_s)) record.add(life_sign("monitor", false), from_seconds(t_s + 5.0));
    }
    AlignmentStatus aligned;
    aligned.phase = AlignmentPhase::aligned;
    aligned.header.stamp_ns = at(kAlignedS);
    record.add(aligned);
    for (const Alarm& alarm : alarms) record.add(alarm);
    return record.look(at(ends_s), from_seconds(ends_s + 5.0));
  }

  [[nodiscard]] std::vector<Finding> judged() const { return judge(observed(), demands_); }

  /// The sentences of the demands that were not met.
  [[nodiscard]] std::vector<std::string> failures() const {
    std::vector<std::string> out;
    for (const Finding& finding : judged()) {
      EXPECT_FALSE(finding.text.empty());
      if (!finding.met) out.push_back(finding.text);
    }
    return out;
  }

 private:
  [[nodiscard]] NavState state(double t_s) const {
    NavState out;
    out.header.stamp_ns = at(t_s);
    out.alignment = t_s < kAlignedS ? AlignmentPhase::averaging : AlignmentPhase::aligned;
    out.mode = t_s < kAlignedS ? NavMode::aligning : NavMode::gps_aided;
    if (lost.has(t_s)) out.mode = NavMode::none;
    out.latitude_rad = not_finite.has(t_s) ? std::numeric_limits<double>::quiet_NaN() : 0.6;
    out.longitude_rad = 2.2;
    out.altitude_m = 0.0;
    out.velocity_N_m_s = {0.0, 0.0, 0.0};
    out.q_NB = {1.0, 0.0, 0.0, 0.0};
    out.rpy_rad = {0.0, 0.0, 0.0};
    return out;
  }
  static Truth truth(double t_s) {
    Truth out;
    out.header.stamp_ns = at(t_s);
    out.latitude_rad = 0.6;
    out.longitude_rad = 2.2;
    out.altitude_m = 0.0;
    out.velocity_N_m_s = {0.0, 0.0, 0.0};
    out.rpy_rad = {0.0, 0.0, 0.0};
    return out;
  }
  static GpsSample fix(double t_s) {
    GpsSample out;
    out.header.stamp_ns = at(t_s);
    out.fix = GpsFix::fix_3d;
    out.latitude_rad = 0.6;
    out.longitude_rad = 2.2;
    return out;
  }
  [[nodiscard]] MonitorStatus monitor(double t_s) const {
    MonitorStatus out;
    out.header.stamp_ns = at(t_s);
    out.gps_outage_active = flag.has(t_s);
    return out;
  }
  static ServiceStatus life_sign(const char* name, bool degraded) {
    ServiceStatus out;
    out.header.sensor = name;
    out.state = degraded ? ServiceState::degraded : ServiceState::healthy;
    out.text = degraded ? "no inertial samples" : "";
    return out;
  }

  Demands demands_;
};

Alarm alarm(const char* name) {
  Alarm out;
  out.alarm = name;
  out.severity = Severity::critical;
  out.text = "There is something.";
  return out;
}

TEST(Judgement, ARunInWhichAllGoesWellPasses) {
  const Voyage run;
  EXPECT_THAT(run.failures(), IsEmpty());
  EXPECT_NEAR(rate_hz(run.observed(), Voyage().demands()), 100.0, 0.1);
  EXPECT_NEAR(valid_share(run.observed(), Voyage().demands()), 1.0, 0.001);
}

TEST(Judgement, NavigationThatIsLostFails) {
  Voyage run;
  run.lost = {30.0, kRunS};  // states go on to come, without a position
  EXPECT_THAT(
      run.failures(),
      ElementsAre("40.00 % of the navigation states due were there and valid, at least 99 % expected"));
}

TEST(Judgement, StatesWithoutNumbersFail) {
  Voyage run;
  run.not_finite = {30.0, 31.0};
  EXPECT_THAT(run.failures(), ElementsAre(HasSubstr("98.00 % of the navigation states due")));
}

TEST(Judgement, NavigationThatFallsSilentFails) {
  Voyage run;
  run.no_states = {30.0, kRunS};
  EXPECT_THAT(run.failures(), ElementsAre(HasSubstr("navigation state at 49.6 Hz over the run"),
                                          HasSubstr("navigation states due were there and valid")));
}

TEST(Judgement, NavigationThatBeginsLateFails) {
  Voyage run;
  run.nav_starts_s = 50.0;
  EXPECT_THAT(run.failures(), ElementsAre(HasSubstr("Hz over the run"), HasSubstr("there and valid")));
}

TEST(Judgement, RepeatedStatesDoNotMakeUpForMissingOnes) {
  Voyage run;
  run.copies = 2;
  run.no_states = {30.0, 50.0};
  EXPECT_THAT(run.failures(), ElementsAre(HasSubstr("Hz over the run"), HasSubstr("there and valid")));
}

TEST(Judgement, AStumbleOfHalfASecondIsNotAFall) {
  Voyage run;
  run.no_states = {30.0, 30.4};
  EXPECT_THAT(run.failures(), IsEmpty());
}

TEST(Judgement, AServiceThatHangsFails) {
  Voyage run;
  run.mute_fusion = {50.0, kRunS};
  EXPECT_THAT(run.failures(), ElementsAre("service fusion gave no life sign for 11.0 s, limit 4.5 s"));
  run.mute_fusion = {30.0, 36.0};  // and one that wakes up again
  EXPECT_THAT(run.failures(), ElementsAre("service fusion gave no life sign for 7.0 s, limit 4.5 s"));
  run.mute_fusion = {30.0, 33.0};
  EXPECT_THAT(run.failures(), IsEmpty());
}

TEST(Judgement, AMonitorThatHangsFails) {
  Voyage run;
  run.mute_monitor = {15.0, kRunS};
  EXPECT_THAT(run.failures(), ElementsAre(HasSubstr("GPS outage at 19.5 s of 20.5 s was not flagged"),
                                          HasSubstr("0 GPS outages flagged and cleared"),
                                          HasSubstr("service monitor gave no life sign")));
}

TEST(Judgement, AServiceThatIsUnwellFails) {
  Voyage run;
  run.falls = true;
  EXPECT_THAT(run.failures(), ElementsAre("service fusion did not stay healthy: no inertial samples"));
}

TEST(Judgement, AnOutageThatIsNeverClearedFails) {
  Voyage run;
  run.flag = {25.1, 1e9};
  EXPECT_THAT(run.failures(), ElementsAre(HasSubstr("was never cleared, although fixes came again 20.0 s"),
                                          HasSubstr("0 GPS outages flagged and cleared")));
}

TEST(Judgement, AnOutageThatIsClearedLateFails) {
  Voyage run;
  run.flag = {25.1, 55.0};
  EXPECT_THAT(run.failures(), ElementsAre(HasSubstr("cleared 15.00 s after the first fix, limit 10 s")));
}

TEST(Judgement, AnOutageThatIsClearedWithoutAFixFails) {
  Voyage run;
  run.flag = {25.1, 30.0};
  EXPECT_THAT(run.failures(), ElementsAre(HasSubstr("was cleared without a usable fix"),
                                          HasSubstr("0 GPS outages flagged and cleared")));
}

TEST(Judgement, AnOutageThatLastsAndIsNotFlaggedFails) {
  Voyage run;
  run.gps_gone = {40.0, 1e9};
  run.flag = {};
  run.demands().limits.gps_outages_at_least = 0;
  EXPECT_THAT(run.failures(), ElementsAre(HasSubstr("GPS outage at 39.5 s of 20.5 s was not flagged")));
}

TEST(Judgement, AnOutageThatLastsAndIsFlaggedIsNoFault) {
  Voyage run;
  run.gps_gone = {40.0, 1e9};
  run.flag = {45.1, 1e9};
  run.demands().limits.gps_outages_at_least = 0;
  EXPECT_THAT(run.failures(), IsEmpty());
}

TEST(Judgement, ALoneFixEndsNoOutage) {
  Voyage run;
  run.lone_fixes_s = {30.0};
  EXPECT_THAT(run.failures(), IsEmpty());
  EXPECT_EQ(run.observed().outages.size(), 1U);
  run.gps_gone = {20.0, 1e9};
  run.flag = {25.1, 1e9};
  run.demands().limits.gps_outages_at_least = 0;
  EXPECT_THAT(run.failures(), IsEmpty()) << "it lasts to the end";
}

TEST(Judgement, AnAlarmThatNobodyExpectsFails) {
  Voyage run;
  run.alarms = {alarm("gps_outage"), alarm("gps_outage:gps")};
  EXPECT_THAT(run.failures(), IsEmpty());
  run.alarms.push_back(alarm("nav_state_slow"));
  EXPECT_THAT(
      run.failures(),
      ElementsAre(
          "alarm nav_state_slow (critical) was raised and is not expected here: There is something."));
  run.demands().expected_alarms = {"gps_outage", "nav_state_slow"};
  EXPECT_THAT(run.failures(), ElementsAre(HasSubstr("alarm gps_outage:gps")));
}

TEST(Judgement, ServicesThatWereRestartedOrKilledOrNeverHeardFail) {
  Voyage run;
  run.demands().services.emplace_back("dvl_bridge");
  run.demands().restarts = {{"fusion", 2}};
  run.demands().killed = {"monitor"};
  EXPECT_THAT(run.failures(),
              ElementsAre("service fusion was started again 2 times", "service dvl_bridge was never heard",
                          "service monitor did not stop when asked"));
}

TEST(Judgement, ARunWithoutAnythingFails) {
  Voyage run;
  run.nav_starts_s = 1e9;
  EXPECT_THAT(run.failures(), ElementsAre(HasSubstr("0.0 Hz"), HasSubstr("0.00 % of the navigation states"),
                                          HasSubstr("no navigation state with a position")));
}

TEST(Report, HasTheFindingsAndTheNamesThatScriptsRead) {
  Voyage run;
  run.lost = {30.0, kRunS};
  const auto seen = run.observed();
  const auto json = nlohmann::json::parse(
      report_json("survey", kRunS, seen, run.demands(), judge(seen, run.demands()), ""));
  for (const char* key :
       {"scenario", "duration_s", "nav_state_rate_hz", "horizontal_error_m", "attitude_error_deg",
        "gps_outages", "alignment", "latency_us", "services", "verdicts", "alarms"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_NEAR(json["nav_state_valid_share"].get<double>(), 0.4, 0.01);
  EXPECT_EQ(json["latency_us"]["p50"], 300.0);
  EXPECT_TRUE(std::any_of(json["findings"].begin(), json["findings"].end(),
                          [](const auto& finding) { return finding["met"] == false; }));
}

}  // namespace
}  // namespace fathom::demo
