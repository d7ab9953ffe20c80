#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "console/http/fan_out.hpp"
#include "console/view/vehicle_view.hpp"
#include "console/view/vehicle_view_json.hpp"
#include "unit/console/utc.hpp"

namespace fathom::console {
namespace {

/// A vehicle seen by a console, with its own clock.
struct Scene {
  VehicleView view{{"auv", 3, 0.7}};
  health::Instant now{kNsPerSecond, kUtc};

  void wait(double seconds) {
    now.monotonic_ns += from_seconds(seconds);
    now.utc_ns += from_seconds(seconds);
  }
  template <class T>
  void add(T sample, const char* sensor, const char* vehicle = "auv") {
    sample.header.vehicle = vehicle;
    sample.header.sensor = sensor;
    if (sample.header.stamp_ns == 0) sample.header.stamp_ns = now.utc_ns;
    if (sample.header.received_ns == 0) sample.header.received_ns = now.utc_ns;
    view.add(sample, now);
  }
  void nav() {
    NavState state;
    state.mode = NavMode::gps_aided;
    state.latitude_rad = 36.4 * kRadPerDeg;
    state.longitude_rad = 127.4 * kRadPerDeg;
    state.position_covariance_N_m2 = {4, 1, 0, 1, 9, 0, 0, 0, 9};
    add(state, "fusion");
  }
  void gps(TimeNs stamp_ns) {
    GpsSample sample;
    sample.header.stamp_ns = stamp_ns;
    sample.fix = GpsFix::fix_3d;
    sample.latitude_rad = 36.4 * kRadPerDeg;
    sample.longitude_rad = 127.4 * kRadPerDeg;
    add(sample, "gps");
  }
  void verdict(TimeNs stamp_ns, VerdictKind kind, const char* sensor = "gps", std::uint32_t revision = 0,
               VerdictKind previous = VerdictKind::used, bool is_final = false) {
    Verdict out;
    out.revision = revision;
    out.previous = revision == 0 ? kind : previous;
    out.is_final = is_final;
    out.header.stamp_ns = stamp_ns;
    out.header.received_ns = stamp_ns + 80 * kNsPerMillisecond;
    out.source = SourceKind::gps;
    out.model = "gps_position";
    out.kind = kind;
    out.dimensions = 2;
    out.innovation = {0.5, -0.25};
    out.innovation_sigma = {1.0, 2.0};
    out.test_ratio = 0.125;
    add(out, sensor);
  }
  nlohmann::json tick() { return nlohmann::json::parse(tick_json(view.tick(now))); }
  nlohmann::json snapshot() { return nlohmann::json::parse(snapshot_json(view.snapshot())); }
};

TEST(VehicleView, WithNothingHeardEverythingIsUnknownAndStillJson) {
  Scene scene;
  const auto tick = scene.tick();
  EXPECT_EQ(tick["tick"], 1);
  EXPECT_EQ(tick["trust"]["level"], "bad");
  EXPECT_TRUE(tick["status"]["navigation"].is_null());
  EXPECT_EQ(tick["status"]["domain"], 3);
  EXPECT_TRUE(tick["nav"].empty());
  const auto snapshot = scene.snapshot();
  EXPECT_EQ(snapshot["tick"], 1);
  EXPECT_EQ(snapshot["nav_columns"].size(), kNavColumns.size());
  EXPECT_EQ(snapshot["verdict_kinds"].size(), kVerdictKinds);
}

TEST(VehicleView, ATickSaysWhatDdsSaid) {
  Scene scene;
  scene.nav();
  scene.wait(0.05);
  const auto tick = scene.tick();
  EXPECT_NEAR(tick["status"]["navigation"]["lat_deg"].get<double>(), 36.4, 1e-9);
  EXPECT_NEAR(tick["status"]["navigation"]["age_s"].get<double>(), 0.05, 1e-6);
  EXPECT_EQ(tick["horizontal_covariance_m2"], nlohmann::json::array({4, 1, 9}));
  ASSERT_EQ(tick["nav"].size(), 1U);
  ASSERT_EQ(tick["nav"][0].size(), 1 + kNavColumns.size());
  EXPECT_NEAR(tick["nav"][0][1].get<double>(), 36.4, 1e-8);
  EXPECT_TRUE(tick["nav"][0][3].is_null()) << "an altitude that is unknown";
  EXPECT_TRUE(scene.tick()["nav"].empty()) << "said once";
  EXPECT_EQ(scene.snapshot()["nav"].size(), 1U);
}

TEST(VehicleView, NavigationThatStoppedIsGoneBeforeASecondIsOver) {
  Scene scene;
  scene.nav();
  scene.wait(0.6);
  EXPECT_EQ(scene.tick()["trust"]["sentence"].get<std::string>().find("No navigation"), std::string::npos);
  scene.wait(0.2);
  EXPECT_EQ(scene.tick()["trust"]["sentence"].get<std::string>().find("No navigation"), 0U);
}

TEST(VehicleView, AFixIsShownWithItsVerdictWhicheverCameFirst) {
  Scene scene;
  scene.gps(kUtc);
  EXPECT_TRUE(scene.tick()["fixes"].empty()) << "waits for its verdict";
  scene.verdict(kUtc, VerdictKind::rejected);
  const auto rejected = scene.tick()["fixes"];
  ASSERT_EQ(rejected.size(), 1U);
  EXPECT_EQ(rejected[0][6], static_cast<int>(VerdictKind::rejected));
  EXPECT_EQ(rejected[0][4], "gps");
  scene.verdict(kUtc + 2 * kNsPerSecond, VerdictKind::used);
  scene.gps(kUtc + 2 * kNsPerSecond);
  EXPECT_EQ(scene.tick()["fixes"][0][6], 0);
  scene.gps(kUtc + 4 * kNsPerSecond);
  scene.wait(3.0);
  EXPECT_TRUE(scene.tick()["fixes"][0][6].is_null()) << "fusion never mentioned it";
}

TEST(VehicleView, SourcesAreCountedAndAged) {
  Scene scene;
  scene.verdict(kUtc, VerdictKind::used);
  scene.wait(1.5);
  scene.verdict(kUtc + kNsPerSecond, VerdictKind::rejected);
  const auto source = scene.tick()["sources"][0];
  EXPECT_EQ(source["sensor"], "gps");
  EXPECT_EQ(source["last"], "rejected");
  EXPECT_NEAR(source["since_used_s"].get<double>(), 1.5, 1e-6);
  EXPECT_NEAR(source["latency_s"].get<double>(), 0.08, 1e-6);
  EXPECT_EQ(source["counts"][0], 1);
  EXPECT_EQ(source["counts"][1], 1);
  const auto series = scene.snapshot()["verdicts"][0];
  EXPECT_EQ(series["model"], "gps_position");
  EXPECT_EQ(series["rows"][0].size(), 4U + 2U * 2U);
  EXPECT_EQ(series["rows"][0][4], 0.5);
}

TEST(VehicleView, AMeasurementThatIsJudgedAgainIsShownAsJudgedLastAndCountedOnce) {
  Scene scene;
  scene.gps(kUtc);
  scene.verdict(kUtc, VerdictKind::used);
  EXPECT_EQ(scene.tick()["fixes"][0][6], static_cast<int>(VerdictKind::used));
  scene.gps(kUtc + 2 * kNsPerSecond);
  scene.verdict(kUtc + 2 * kNsPerSecond, VerdictKind::used);
  (void)scene.tick();
  scene.verdict(kUtc, VerdictKind::rejected, "gps", 1, VerdictKind::used);
  const auto tick = scene.tick();
  ASSERT_EQ(tick["fixes"].size(), 1U);
  EXPECT_EQ(tick["fixes"][0][6], static_cast<int>(VerdictKind::rejected));
  ASSERT_EQ(tick["verdicts"][0]["rows"].size(), 1U);
  EXPECT_EQ(tick["verdicts"][0]["rows"][0][1], static_cast<int>(VerdictKind::rejected));
  EXPECT_EQ(tick["sources"][0]["counts"][0], 1);
  EXPECT_EQ(tick["sources"][0]["counts"][1], 1);
  EXPECT_EQ(tick["sources"][0]["last"], "used") << "of the newest measurement";
  EXPECT_EQ(tick["status"]["verdicts"]["gps"]["used"], 1);
  EXPECT_EQ(tick["status"]["verdicts"]["gps"]["not_used"], 1);

  scene.verdict(kUtc, VerdictKind::rejected, "gps", 2, VerdictKind::rejected, true);
  scene.verdict(kUtc + 2 * kNsPerSecond, VerdictKind::used, "gps", 1, VerdictKind::used, true);
  const auto after = scene.tick();
  EXPECT_TRUE(after["fixes"].empty()) << "a final verdict that says the same is no news";
  EXPECT_TRUE(after["verdicts"].empty());
  EXPECT_EQ(after["sources"][0]["counts"], tick["sources"][0]["counts"]);
  const auto snapshot = scene.snapshot();
  ASSERT_EQ(snapshot["fixes"].size(), 2U);
  EXPECT_EQ(snapshot["fixes"][0][6], static_cast<int>(VerdictKind::rejected));
  ASSERT_EQ(snapshot["verdicts"][0]["rows"].size(), 2U);
  EXPECT_EQ(snapshot["verdicts"][0]["rows"][0][1], static_cast<int>(VerdictKind::rejected));
}

TEST(VehicleView, OtherVehiclesAreNotShown) {
  Scene scene;
  NavState foreign;
  scene.add(foreign, "fusion", "other");
  GpsSample fix;
  fix.fix = GpsFix::fix_3d;
  fix.latitude_rad = fix.longitude_rad = 0.1;
  scene.add(fix, "gps", "other");
  scene.wait(5.0);
  const auto tick = scene.tick();
  EXPECT_TRUE(tick["status"]["navigation"].is_null());
  EXPECT_TRUE(tick["fixes"].empty());
}

TEST(VehicleView, ARestartIsCounted) {
  Scene scene;
  ServiceStatus status;
  status.pid = 100;
  status.started_ns = kUtc;
  status.counters.push_back({"bus_incompatible_qos", 2});
  scene.add(status, "fusion");
  status.pid = 101;
  status.started_ns = kUtc + 1;
  scene.add(status, "fusion");
  const auto service = scene.tick()["services"][0];
  EXPECT_EQ(service["name"], "fusion");
  EXPECT_EQ(service["restarts"], 1);
  EXPECT_EQ(service["counters"][0][1], 2);
}

TEST(VehicleView, TextFromTheNetworkIsEscaped) {
  Scene scene;
  Alarm alarm;
  alarm.alarm = "odd";
  alarm.active = true;
  alarm.text = "<script>\"\n\xff";
  scene.add(alarm, "monitor");
  EXPECT_EQ(tick_json(scene.view.tick(scene.now)).find('\n'), std::string::npos)
      << "one line: an event ends with the line";
  EXPECT_EQ(scene.tick()["status"]["alarms"].size(), 1U);
}

TEST(VehicleView, ARelativeFixIsPlacedFromItsStation) {
  Scene scene;
  UsblSample sample;
  sample.frame = UsblFrame::vessel_frd;
  sample.relative_m = {100.0, 0.0, 20.0};
  sample.station_latitude_rad = 36.4 * kRadPerDeg;
  sample.station_longitude_rad = 127.4 * kRadPerDeg;
  sample.station_rpy_rad = {0.0, 0.0, 90.0 * kRadPerDeg};
  scene.add(sample, "usbl");
  scene.wait(3.0);
  const auto fix = scene.tick()["fixes"][0];
  EXPECT_NEAR(fix[1].get<double>(), 36.4, 1e-6) << "the ship heads east: forward is east";
  EXPECT_NEAR((fix[2].get<double>() - 127.4) * 111195 * std::cos(36.4 * kRadPerDeg), 100.0, 0.5);
}

TEST(VehicleView, ABeaconIsShownWithItsRangeAndVerdict) {
  Scene scene;
  EXPECT_TRUE(scene.tick()["beacons"].empty());
  RangeSample sample;
  sample.header.stamp_ns = kUtc;
  sample.beacon = "2";
  sample.range_m = 80.0;
  sample.beacon_latitude_rad = 36.4 * kRadPerDeg;
  sample.beacon_longitude_rad = 190.0 * kRadPerDeg;
  sample.beacon_depth_m = 40.0;
  scene.add(sample, "range", "another");
  EXPECT_TRUE(scene.tick()["beacons"].empty()) << "another vehicle's";
  scene.add(sample, "range");
  Verdict verdict;
  verdict.header.stamp_ns = kUtc;
  verdict.source = SourceKind::range;
  verdict.kind = VerdictKind::rejected;
  scene.add(verdict, "range");
  scene.wait(1.5);
  const auto beacons = scene.tick()["beacons"];
  ASSERT_EQ(beacons.size(), 1U);
  EXPECT_EQ(beacons[0]["name"], "2");
  EXPECT_EQ(beacons[0]["range_m"], 80.0);
  EXPECT_EQ(beacons[0]["depth_m"], 40.0);
  EXPECT_NEAR(beacons[0]["lon_deg"].get<double>(), -170.0, 1e-9);
  EXPECT_NEAR(beacons[0]["age_s"].get<double>(), 1.5, 1e-6);
  EXPECT_TRUE(beacons[0]["sigma_m"].is_null());
  EXPECT_EQ(beacons[0]["verdict"], static_cast<int>(VerdictKind::rejected));
}

TEST(VehicleView, TheTrackSaysInWhichModeItWas) {
  Scene scene;
  scene.nav();
  const auto tick = scene.tick();
  const auto snapshot = scene.snapshot();
  ASSERT_EQ(snapshot["nav_columns"].back(), "mode");
  const auto mode = tick["nav"][0].back().get<std::size_t>();
  EXPECT_EQ(snapshot["nav_modes"][mode], "gps_aided");
}

TEST(FanOut, ASlowClientLosesItsOldestAndNobodyElseDoes) {
  FanOut events({3, 2, 2});
  const auto slow = events.join("a").client;
  const auto quick = events.join("a").client;
  EXPECT_EQ(events.join("b").refused, FanOut::Refused::all_taken) << "no more than two";
  for (int i = 0; i < 5; ++i) {
    events.publish(std::make_shared<const std::string>(std::to_string(i)));
    EXPECT_EQ(*quick->wait(std::chrono::milliseconds(0)), std::to_string(i));
  }
  EXPECT_EQ(events.dropped(), 2U);
  EXPECT_EQ(*slow->wait(std::chrono::milliseconds(0)), "2");
  EXPECT_EQ(slow->wait(std::chrono::milliseconds(0)).use_count(), 1) << "the bytes are shared and let go";
}

TEST(FanOut, OneViewerLeavesRoomForOthers) {
  FanOut events({3, 5, 2});
  auto first = events.join("a").client;
  const auto second = events.join("a").client;
  ASSERT_TRUE(first && second);
  EXPECT_EQ(events.join("a").refused, FanOut::Refused::viewer_has_enough);
  EXPECT_EQ(events.join("a").client, nullptr);
  EXPECT_NE(events.join("b").client, nullptr);
  first.reset();
  EXPECT_NE(events.join("a").client, nullptr) << "who closes one may open another";
}

TEST(FanOut, WhoLeavesMakesRoomAndClosingWakesEveryone) {
  FanOut events({3, 1, 1});
  auto first = events.join("a").client;
  first.reset();
  const auto second = events.join("a").client;
  ASSERT_NE(second, nullptr);
  events.close();
  EXPECT_EQ(second->wait(std::chrono::hours(1)), nullptr);
  EXPECT_TRUE(second->closed());
  EXPECT_EQ(events.join("b").refused, FanOut::Refused::all_taken);
}

}  // namespace
}  // namespace fathom::console
