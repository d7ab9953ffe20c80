#include "health/vehicle_health.hpp"

#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "timeline.hpp"

namespace fathom::health {
namespace {

/// A whole vehicle, faults as asked for, evaluated at 20 Hz.
class Vehicle {
 public:
  bool fusion_alive = true;
  bool gps_fix = true;
  bool gps_bridge_alive = true;
  double host_clock_set_s = 0.0;
  std::uint32_t fusion_pid = 100;
  VehicleHealth health{of_three_instruments(), at(0.0)};
  std::multiset<std::string> raised;

  void until(double end_s) {
    for (; tick_ < std::llround(end_s * 100.0); ++tick_) {
      const double t = 0.01 * static_cast<double>(tick_);
      const Instant now = at(t);
      health.heard(SourceKind::imu, header("imu", t), now);
      if (fusion_alive) health.add(nav(t, gps_fix ? NavMode::gps_aided : NavMode::dead_reckoning), now);
      if (tick_ % 20 == 0) health.heard(SourceKind::dvl, header("dvl", t), now);
      if (tick_ % 50 == 0 && gps_bridge_alive) health.add(gps(t, gps_fix), now);
      if (tick_ % 100 == 0) {
        if (fusion_alive) add(life_sign("fusion", t, ServiceState::healthy, fusion_pid), now);
        if (gps_bridge_alive) add(life_sign("gps_bridge", t), now);
      }
      if (tick_ % 5 == 0) {
        health.evaluate(now);
        for (const auto& [event, alarm] : health.take_transitions()) {
          // Once per occurrence: what becomes more severe is not raised anew.
          if (!alarm.active) {
            active_.erase(alarm.alarm.str());
          } else if (active_.insert(alarm.alarm.str()).second) {
            raised.insert(alarm.alarm.str());
          }
        }
      }
    }
    now_s_ = end_s;
  }
  [[nodiscard]] MonitorStatus status() const { return health.status(at(now_s_)); }

 private:
  void add(ServiceStatus status, const Instant& now) {
    status.utc_offset_ns = from_seconds(host_clock_set_s);
    health.add(status, now);
  }

  std::set<std::string> active_;
  std::int64_t tick_ = 0;
  double now_s_ = 0.0;
};

TEST(VehicleHealth, ACleanHourRaisesNothing) {
  Vehicle vehicle;
  vehicle.until(3600.0);
  EXPECT_TRUE(vehicle.raised.empty()) << *vehicle.raised.begin();
  const MonitorStatus status = vehicle.status();
  EXPECT_TRUE(status.healthy);
  EXPECT_EQ(status.mode, NavMode::gps_aided);
  EXPECT_EQ(status.alignment, AlignmentPhase::aligned);
  EXPECT_EQ(status.gps_outage_s, 0.0);
  ASSERT_EQ(status.sensors.size(), 3u);
  EXPECT_NEAR(status.sensors[0].rate_hz, 100.0, 2.0);
  ASSERT_EQ(status.services.size(), 2u);
}

TEST(VehicleHealth, ADiveIsExactlyOneOutage) {
  Vehicle vehicle;
  vehicle.until(35.0);
  vehicle.gps_fix = false;
  vehicle.until(65.0);
  EXPECT_FALSE(vehicle.status().healthy);
  EXPECT_TRUE(vehicle.status().gps_outage_active);
  EXPECT_NEAR(vehicle.status().gps_outage_s, 30.5, 0.1);
  vehicle.gps_fix = true;
  vehicle.until(70.0);
  EXPECT_EQ(vehicle.raised, std::multiset<std::string>{"gps_outage"});
  const MonitorStatus status = vehicle.status();
  EXPECT_TRUE(status.healthy);
  EXPECT_EQ(status.gps_outage_count, 1u);
  EXPECT_NEAR(status.gps_outage_longest_s, 30.5, 0.1);
  EXPECT_NEAR(status.gps_outage_total_s, 30.5, 0.1);
  EXPECT_EQ(status.alarms_active, 0u);
  EXPECT_EQ(status.alarms_unacknowledged, 1u);
}

TEST(VehicleHealth, AFixThatFusionRefusesAfterAllEndsNoOutageAndWhatItSaysAgainCountsForNothing) {
  const auto judged = [](double t, std::uint32_t revision, VerdictKind previous, VerdictKind kind) {
    Verdict out = verdict(SourceKind::gps, kind, t, "gps");
    out.revision = revision;
    out.previous = previous;
    return out;
  };
  const auto outage_after = [&](bool revised) {
    VehicleHealth health{of_three_instruments(), at(0.0)};
    for (double t = 0.0; t < 40.0; t += 0.1) {
      const bool fix = t < 5.0 || t > 20.0;
      const bool tenth = std::llround(10.0 * t) % 5 == 0;
      if (tenth) health.add(gps(t, fix), at(t));
      if (tenth && fix) {
        health.add(judged(t, 0, VerdictKind::used, VerdictKind::used), at(t));
        if (revised && t > 20.0) {
          health.add(judged(t, 1, VerdictKind::used, VerdictKind::rejected), at(t));
          health.add(judged(t, 2, VerdictKind::rejected, VerdictKind::rejected), at(t));
        } else {
          health.add(judged(t, 1, VerdictKind::used, VerdictKind::used), at(t));
        }
      }
      health.evaluate(at(t));
    }
    return health.status(at(40.0)).gps_outage_active;
  };
  EXPECT_FALSE(outage_after(false));
  EXPECT_TRUE(outage_after(true));
}

TEST(VehicleHealth, AFinalVerdictOnTheLastRefusalIsNoSecondOne) {
  // Five refusals in a row within ten seconds are an alarm; four, each said twice, are none.
  VehicleHealth health{of_three_instruments(), at(0.0)};
  for (double t = 0.0; t < 16.0; t += 4.0) {
    Verdict refused = verdict(SourceKind::dvl, VerdictKind::rejected, t, "dvl");
    refused.previous = VerdictKind::rejected;
    health.add(refused, at(t));
    refused.revision = 1;
    refused.is_final = true;
    health.add(refused, at(t));
    health.evaluate(at(t));
  }
  for (const auto& [event, alarm] : health.take_transitions()) EXPECT_NE(alarm.alarm, Name("refused:dvl"));
}

TEST(VehicleHealth, DeadFusionIsSeenAndGpsOutagesAreStillKept) {
  Vehicle vehicle;
  vehicle.until(20.0);
  vehicle.fusion_alive = false;
  vehicle.gps_fix = false;
  vehicle.until(40.0);
  const MonitorStatus dead = vehicle.status();
  EXPECT_FALSE(dead.healthy);
  EXPECT_EQ(dead.mode, NavMode::none);
  EXPECT_EQ(dead.alignment, AlignmentPhase::none);
  EXPECT_TRUE(dead.gps_outage_active);
  EXPECT_EQ(vehicle.raised,
            (std::multiset<std::string>{"gps_outage", "nav_state_missing", "service_missing:fusion"}));
  vehicle.fusion_alive = true;
  vehicle.fusion_pid = 101;
  vehicle.gps_fix = true;
  vehicle.until(50.0);
  EXPECT_TRUE(vehicle.status().healthy);
  EXPECT_EQ(vehicle.raised.count("service_restarted:fusion"), 1u);
}

TEST(VehicleHealth, AClockThatIsSetRaisesOneNoticeForItsHostAndMovesNothing) {
  Vehicle vehicle;
  vehicle.until(20.0);
  vehicle.gps_fix = false;
  vehicle.until(30.0);
  const TimeNs before = vehicle.health.alarms().find("gps_outage")->since_ns;
  vehicle.host_clock_set_s = -3600.0;
  vehicle.until(35.0);
  EXPECT_EQ(vehicle.raised, (std::multiset<std::string>{"clock_step", "gps_outage"}));
  EXPECT_EQ(vehicle.health.alarms().find("gps_outage")->since_ns, before);
  EXPECT_NEAR(vehicle.health.alarms().find("clock_step")->value, -3600.0, 1e-6);
  EXPECT_NEAR(vehicle.status().gps_outage_s, 15.5, 0.1);
  vehicle.host_clock_set_s = 0.0;
  vehicle.until(40.0);
  EXPECT_EQ(vehicle.raised.count("clock_step"), 2u);
}

TEST(VehicleHealth, AServiceThatStartsUnderAnotherOffsetIsNoStep) {
  Vehicle vehicle;
  vehicle.until(20.0);
  vehicle.fusion_alive = false;
  vehicle.until(22.0);
  vehicle.fusion_alive = true;
  vehicle.fusion_pid = 101;
  vehicle.host_clock_set_s = 0.2;  // slewed, not set
  vehicle.until(30.0);
  EXPECT_EQ(vehicle.raised.count("clock_step"), 0u);
}

TEST(VehicleHealth, OtherVehiclesAreNotOurs) {
  VehicleHealth health(of_three_instruments(), at(0.0));
  GpsSample foreign = gps(1.0);
  foreign.header.vehicle = "other";
  health.add(foreign, at(1.0));
  NavState state = nav(1.0);
  state.header.vehicle = "other";
  health.add(state, at(1.0));
  health.evaluate(at(1.0));
  const MonitorStatus status = health.status(at(1.0));
  EXPECT_TRUE(std::isnan(status.gps_outage_s));
  EXPECT_TRUE(std::isnan(status.nav_state_age_s));
  EXPECT_EQ(status.sensors[1].presence, Presence::never_seen);
}

TEST(VehicleHealth, AcknowledgesOnlyWhatItIsToldTo) {
  Vehicle vehicle;
  vehicle.until(20.0);
  vehicle.gps_bridge_alive = false;
  vehicle.until(40.0);
  EXPECT_EQ(vehicle.raised,
            (std::multiset<std::string>{"gps_outage", "sensor_missing:gps", "service_missing:gps_bridge"}));
  Command command;
  command.header = header("operator", 40.0);
  command.target = "gps_outage";
  command.kind = CommandKind::disable_source;
  EXPECT_EQ(vehicle.health.apply(command, at(40.0)), 0);
  command.kind = CommandKind::acknowledge_alarm;
  EXPECT_EQ(vehicle.health.apply(command, at(40.0)), 1);
  EXPECT_TRUE(vehicle.health.alarms().find("gps_outage")->acknowledged);
  EXPECT_EQ(vehicle.status().alarms_unacknowledged, 2u);
  command.header.vehicle = "other";
  command.target = "*";
  EXPECT_EQ(vehicle.health.apply(command, at(40.0)), 0);
}

}  // namespace
}  // namespace fathom::health
