#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pty.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "live/status/table.hpp"
#include "status/json.hpp"
#include "status/judgement.hpp"

namespace fathom::cli {
namespace {

using status::Condition;
using status::Heard;
using status::StatusView;
using status::VerdictCounts;

StatusView healthy_view() {
  StatusView view;
  view.utc_ns = 1'700'000'000 * kNsPerSecond;
  view.vehicle = "auv";
  view.nav = Heard<NavState>{{}, 0.01};
  NavState& nav = view.nav->sample;
  nav.mode = NavMode::dead_reckoning;
  nav.alignment = AlignmentPhase::aligned;
  nav.latitude_rad = 0.6;
  nav.longitude_rad = 2.2;
  nav.position_covariance_N_m2 = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  view.nav_rate_hz = 100.0;
  view.monitor = Heard<MonitorStatus>{{}, 0.1};
  MonitorStatus& monitor = view.monitor->sample;
  monitor.known = true;
  monitor.healthy = true;
  monitor.gps_outage_s = 0.0;
  monitor.sensors = {{"imu", Presence::present, 0.01, 100.0}, {"dvl", Presence::missing, 12.0, 0.0}};
  monitor.services = {{"fusion", Presence::present, 0.5, 1.0},
                      {"usbl_bridge", Presence::never_seen, kUnknown, kUnknown}};
  ServiceStatus fusion;
  fusion.state = ServiceState::healthy;
  fusion.pid = 42;
  fusion.host = "auv1";
  view.services["fusion"] = {fusion, 0.5};
  view.verdicts["dvl"] = {10, 2, VerdictKind::rejected};
  return view;
}

std::string joined(const StatusView& view, int width, bool colour) {
  std::string out;
  for (const std::string& line : table(view, width, colour)) out += line + "\n";
  return out;
}

TEST(StatusView, ConditionsAndTheirReasons) {
  EXPECT_EQ(judge(healthy_view()).condition, Condition::healthy);
  EXPECT_TRUE(judge(healthy_view()).reasons.empty());
  EXPECT_EQ(judge(StatusView{}).condition, Condition::no_navigation);
  struct Case {
    Condition expected;
    void (*spoil)(StatusView&);
  };
  const Case cases[] = {
      {Condition::no_navigation, [](StatusView& v) { v.nav.reset(); }},
      {Condition::no_navigation, [](StatusView& v) { v.nav->age_s = 1.5; }},
      {Condition::no_navigation, [](StatusView& v) { v.nav->sample.mode = NavMode::aligning; }},
      {Condition::no_navigation, [](StatusView& v) { v.nav->sample.latitude_rad = kUnknown; }},
      {Condition::degraded, [](StatusView& v) { v.monitor.reset(); }},
      {Condition::degraded, [](StatusView& v) { v.monitor->age_s = 10.0; }},
      {Condition::degraded, [](StatusView& v) { v.monitor->sample.healthy = false; }},
      {Condition::degraded,
       [](StatusView& v) { v.monitor->sample.known = v.monitor->sample.healthy = false; }},
      {Condition::degraded, [](StatusView& v) { v.services["fusion"].age_s = 10.0; }},
      {Condition::degraded,
       [](StatusView& v) { v.services["fusion"].sample.state = ServiceState::degraded; }},
  };
  for (const Case& item : cases) {
    StatusView view = healthy_view();
    item.spoil(view);
    EXPECT_EQ(judge(view).condition, item.expected);
    EXPECT_EQ(judge(view).reasons.size(), 1u);
  }
}

TEST(StatusView, TheTableNamesEverythingAndKeepsToItsWidth) {
  StatusView view = healthy_view();
  Alarm alarm;
  alarm.alarm = "sensor_missing:dvl";
  alarm.severity = Severity::warning;
  alarm.active = true;
  alarm.text = "Nothing was heard from sensor dvl for 12.0 s (limit 2.0 s).";
  view.alarms["sensor_missing:dvl"] = alarm;
  const std::string text = joined(view, 120, false);
  for (const char* word : {"auv", "healthy", "dead_reckoning", "imu", "missing", "10 / 2 rejected", "fusion",
                           "42 on auv1", "usbl_bridge", "never_seen", "sensor_missing:dvl", "+-2.45 m"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
  }
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  for (const int width : {20, 40, 80}) {
    for (const std::string& line : table(view, width, false))
      EXPECT_LE(line.size(), static_cast<std::size_t>(width));
  }
  EXPECT_NE(joined(view, 120, true).find("\x1b[32m"), std::string::npos);
}

TEST(StatusView, WithoutATerminalNothingIsCut) {
  StatusView view = healthy_view();
  Alarm alarm;
  alarm.alarm = "service_unwell:gps_bridge_two";
  alarm.active = true;
  alarm.text = "Service gps_bridge_two has been unwell for 3 min 20 s: " + std::string(170, 'x') + " end.";
  view.alarms[alarm.alarm] = alarm;
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  setenv("COLUMNS", "80", 1);
  const std::string text = joined(view, width_of(ends[1]), false);
  unsetenv("COLUMNS");
  EXPECT_NE(text.find("service_unwell:gps_bridge_two "), std::string::npos) << text;
  EXPECT_NE(text.find(alarm.text), std::string::npos) << text;
  close(ends[0]);
  close(ends[1]);
  int device = -1;
  int line = -1;
  winsize size{};
  size.ws_col = 72;
  ASSERT_EQ(openpty(&device, &line, nullptr, nullptr, &size), 0);
  EXPECT_EQ(width_of(line), 72);
  close(device);
  close(line);
}

TEST(StatusView, TheAlignmentUnderWayShowsEachConditionAndWhatWouldHelp) {
  StatusView view = healthy_view();
  view.alignment = Heard<AlignmentStatus>{{}, 0.1};
  AlignmentStatus& status = view.alignment->sample;
  status.phase = AlignmentPhase::waiting;
  status.in_phase_s = 12.4;
  status.rpy_sigma_rad = {0.0873, 0.0436, 0.01745};
  status.time_to_aligned_s = 3.2;
  status.condition_count = 4;
  status.conditions[0] = {"roll_rad", 0.0349, 0.2618, 2.5, 3.0, false};
  status.conditions[1] = {"rate_y_rad_s", 0.0175, 0.0524, 1.4, 1.0, true};
  status.conditions[2] = {"depth_error_m", -14.0, 10.0, 0.0, 1.0, false};
  status.conditions[3] = {"heading_known", 1.0, 1.0, 0.0, 0.0, true};
  const std::string advice = "Hold depth within 10 m of the set 80 m.";
  std::copy(advice.begin(), advice.end(), status.advice.begin());
  const std::string text = joined(view, 120, false);
  for (const char* words : {"waiting for 12 s, aligned in about 3 s", "roll 5.00  pitch 2.50  yaw 1.00 deg",
                            "waiting roll 2 (limit 15 deg), held 2.5 of 3.0 s",
                            "met     rate_y 1 (limit 3 deg/s), held 1.4 of 1.0 s",
                            "waiting depth_error -14 (limit 10 m), held 0.0 of 1.0 s",
                            "met     heading_known 1 (limit 1)\n", advice.c_str()}) {
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
  }
  const auto json = nlohmann::json::parse(json_line(view));
  EXPECT_NEAR(json["alignment"]["rpy_sigma_deg"][0].get<double>(), 5.0, 0.01);
  EXPECT_EQ(json["alignment"]["conditions"][2]["value"], -14.0);
  EXPECT_EQ(json["alignment"]["advice"], advice);
  status.phase = AlignmentPhase::aligned;
  EXPECT_EQ(joined(view, 120, false).find("depth_error"), std::string::npos);
}

TEST(StatusView, AlarmsOverAndUnacknowledgedComeLast) {
  StatusView view;
  for (const auto& [key, severity, active] : {std::tuple{"over", Severity::critical, false},
                                              {"warn", Severity::warning, true},
                                              {"crit", Severity::critical, true}}) {
    Alarm alarm;
    alarm.alarm = key;
    alarm.severity = severity;
    alarm.active = active;
    view.alarms[key] = alarm;
  }
  const auto sorted = sorted_alarms(view);
  EXPECT_EQ(sorted[0].alarm, Name("crit"));
  EXPECT_EQ(sorted[1].alarm, Name("warn"));
  EXPECT_EQ(sorted[2].alarm, Name("over"));
}

TEST(StatusView, ReceiversAreToldApartWhereThereAreSeveral) {
  StatusView view = healthy_view();
  MonitorStatus& monitor = view.monitor->sample;
  monitor.receivers = {{"bow", false, Severity::notice, 0, 0.0, 30.0, 42.0, 2}};
  EXPECT_EQ(joined(view, 120, false).find("bow"), std::string::npos) << "the only receiver is the vehicle's";
  monitor.receivers.push_back(
      {"stern", true, Severity::warning, 1'700'000'000 * kNsPerSecond, 61.5, 61.5, 61.5, 1});
  const std::string shown = joined(view, 120, false);
  EXPECT_NE(shown.find("bow       fix  outages 2, longest 30.0 s, in all 42.0 s"), std::string::npos)
      << shown;
  EXPECT_NE(shown.find("no fix for 61.5 s since 22:13:20Z, warning"), std::string::npos) << shown;
  const auto gps = nlohmann::json::parse(json_line(view))["gps"];
  ASSERT_EQ(gps["receivers"].size(), 2U);
  EXPECT_TRUE(gps["receivers"][0]["since_utc"].is_null());
  EXPECT_EQ(gps["receivers"][1]["severity"], "warning");
  EXPECT_EQ(gps["receivers"][1]["total_s"], 61.5);
}

TEST(StatusView, AFixThatIsRefusedIsNotCalledNone) {
  StatusView view = healthy_view();
  MonitorStatus& monitor = view.monitor->sample;
  monitor.gps_outage_active = true;
  monitor.gps_outage_s = 34.0;
  monitor.receivers = {{"gps", true, Severity::warning, 0, 34.0, 34.0, 34.0, 1}};
  monitor.sensors.clear();
  view.verdicts["gps"].last = VerdictKind::disputed;
  view.verdicts["gps"].last_age_s = 0.1;
  view.verdicts["gps"].refused_for_s = 32.5;
  const std::string shown = joined(view, 160, false);
  EXPECT_NE(shown.find("gps has a fix that navigation has refused for 32.5 s, none used for 34.0 s since"),
            std::string::npos)
      << shown;
}

TEST(StatusView, JsonIsOneLineWithNullForTheUnknown) {
  StatusView view = healthy_view();
  view.nav->sample.depth_m = kUnknown;
  view.forecast = Heard<Forecast>{{}, 0.5};
  view.forecast->sample.limit_count = 1;
  view.forecast->sample.limits[0] = {"horizontal_100m", 100.0, 2.0, std::numeric_limits<double>::infinity()};
  const std::string line = json_line(view);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json["condition"], "healthy");
  EXPECT_TRUE(json["navigation"]["depth_m"].is_null());
  EXPECT_NEAR(json["navigation"]["lat_deg"].get<double>(), 34.377467707849391, 1e-9);
  EXPECT_TRUE(json["alignment"].is_null());
  EXPECT_EQ(json["sensors"].size(), 2u);
  EXPECT_EQ(json["verdicts"]["dvl"]["not_used"], 2);
  EXPECT_EQ(json["services"][1]["state"], "never_seen");
  EXPECT_TRUE(json["forecast"][0]["time_to_limit_s"].is_null());
  EXPECT_TRUE(json["forecast"][0]["never"]);
  EXPECT_TRUE(nlohmann::json::parse(json_line(StatusView{}))["navigation"].is_null());
}

}  // namespace
}  // namespace fathom::cli
