#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "support/process.hpp"
#include "vehicle_network.hpp"

namespace fathom::test {
namespace {

const std::string kConfig = std::string(FATHOM_SOURCE_DIR) + "/deploy/config/monitor.json";

/// The real fathom-monitor in its own process, a vehicle around it, and an ear for what it says.
class MonitorTest : public ::testing::Test {
 protected:
  void start(std::uint32_t domain, std::vector<std::string> sets, const Clock& clock) {
    std::vector<std::string> arguments{"--config", kConfig};
    sets.push_back("bus.domain=" + std::to_string(domain));
    sets.push_back(R"(sensors=[{"name":"gps","kind":"gps","rate_hz":10,"missing_s":30}])");
    for (const std::string& set : sets) {
      arguments.push_back("--set");
      arguments.push_back(set);
    }
    setenv("FATHOM_DDS_DIR", (std::string(FATHOM_SOURCE_DIR) + "/deploy/dds").c_str(), 1);
    network = std::make_unique<VehicleNetwork>(domain, clock);
    ear = std::make_unique<MonitorEar>(network->participant());
    monitor = std::make_unique<Process>("fathom-monitor", arguments);
    ASSERT_TRUE(wait_until([&] { return ear->status().has_value() && network->commands_heard_by_someone(); }))
        << monitor->err();
  }
  /// Calls `step` every 100 ms of host time until `condition` holds.
  bool drive(const std::function<void()>& step, const std::function<bool()>& condition,
             double seconds = 10.0) {
    auto next = std::chrono::steady_clock::now();
    return wait_until(
        [&] {
          if (std::chrono::steady_clock::now() >= next) {
            step();
            next += std::chrono::milliseconds(100);
          }
          return condition();
        },
        seconds);
  }
  void TearDown() override {
    if (!monitor) return;
    monitor->kill(SIGTERM);
    EXPECT_EQ(monitor->wait(), 0) << monitor->err();
  }

  SystemClock clock;
  std::unique_ptr<VehicleNetwork> network;
  std::unique_ptr<MonitorEar> ear;
  std::unique_ptr<Process> monitor;
};

TEST_F(MonitorTest, AMissingServiceIsNamedClearedWhenItIsBackAndGoneWhenAcknowledged) {
  start(180,
        {R"(services=[{"name":"fusion","severity":"critical"}])", "service_life_signs.missing_s=1.5",
         "navigation.expected=false", "gps.expected=false"},
        clock);
  int beat = 0;
  const auto vehicle = [&](std::uint32_t pid) {
    return [&, pid] {
      network->gps(true);
      if (++beat % 5 == 0 && pid != 0) network->life_sign("fusion", pid);
    };
  };
  ASSERT_TRUE(drive(vehicle(100), [&] {
    return ear->status()->healthy && ear->status()->gps_outage_s == 0.0 &&
           ear->status()->services.at(0).presence == Presence::present;
  }));
  ASSERT_TRUE(drive(vehicle(0), [&] { return ear->active("service_missing:fusion"); }));
  EXPECT_EQ(ear->alarm("service_missing:fusion")->severity, Severity::critical);
  EXPECT_NE(ear->alarm("service_missing:fusion")->text.find("fusion"), std::string::npos);
  EXPECT_TRUE(wait_until([&] { return !ear->status()->healthy; }, 1.0));
  ASSERT_TRUE(drive(vehicle(101), [&] {
    return !ear->active("service_missing:fusion") && ear->alarm("service_restarted:fusion").has_value();
  }));
  EXPECT_TRUE(drive(vehicle(101), [&] { return ear->status()->healthy; }));
  EXPECT_GE(ear->status()->alarms_unacknowledged, 2u);
  network->acknowledge("*");
  EXPECT_TRUE(drive(vehicle(101), [&] {
    return ear->status()->alarms_unacknowledged == 0 && ear->alarm("service_missing:fusion")->acknowledged;
  }));
}

TEST_F(MonitorTest, AGpsOutageIsFlaggedAtItsLimitAndClearedSoonAfterFixesAreBack) {
  start(181, {"services=[]", "navigation.expected=false", "gps.limit_s=1.0", "gps.clear_hold_s=0.5"}, clock);
  ASSERT_TRUE(drive([&] { network->gps(true); }, [&] { return ear->status()->gps_outage_s == 0.0; }));
  const TimeNs lost_ns = clock.monotonic_ns();
  // The receiver keeps talking, without a fix, as under water.
  ASSERT_TRUE(drive([&] { network->gps(false); },
                    [&] { return ear->status()->gps_outage_active && ear->active("gps_outage"); }));
  const double flagged_s = to_seconds(clock.monotonic_ns() - lost_ns);
  EXPECT_GT(flagged_s, 0.8);
  EXPECT_LT(flagged_s, 1.0 + 1.5);
  EXPECT_EQ(ear->alarm("gps_outage")->limit, 1.0);
  EXPECT_EQ(ear->status()->gps_outage_count, 1u);
  const TimeNs back_ns = clock.monotonic_ns();
  ASSERT_TRUE(drive([&] { network->gps(true); },
                    [&] { return !ear->status()->gps_outage_active && !ear->active("gps_outage"); }));
  EXPECT_LT(to_seconds(clock.monotonic_ns() - back_ns), 0.5 + 1.5);
  EXPECT_GT(ear->status()->gps_outage_total_s, 0.9);
  EXPECT_GT(ear->alarm("gps_outage")->cleared_ns, ear->alarm("gps_outage")->since_ns);
}

TEST_F(MonitorTest, WorksInVehicleTimeWhenTheClockIsAccelerated) {
  const TimeNs epoch_ns = clock.utc_ns();
  const ScaledClock fast(epoch_ns, 10.0);
  start(182,
        {"services=[]", "navigation.expected=false", "clock.rate=10",
         "clock.epoch_ns=" + std::to_string(epoch_ns)},
        fast);
  ASSERT_TRUE(drive([&] { network->gps(true); }, [&] { return ear->status()->gps_outage_s == 0.0; }));
  const TimeNs lost_ns = fast.monotonic_ns();
  ASSERT_TRUE(drive([&] { network->gps(false); }, [&] { return ear->active("gps_outage"); }));
  const double flagged_s = to_seconds(fast.monotonic_ns() - lost_ns);
  EXPECT_GT(flagged_s, 4.0);
  EXPECT_LT(flagged_s, 15.0);  // ten times the delays of the host
  EXPECT_NEAR(ear->alarm("gps_outage")->value, flagged_s, 12.0);
}

TEST_F(MonitorTest, DeadFusionIsAnAlarmAndLateReadersHearOfIt) {
  start(183,
        {R"(services=[{"name":"fusion"}])", "service_life_signs.missing_s=1.5", "navigation.missing_s=0.5",
         "navigation.rate_hz=10"},
        clock);
  ASSERT_TRUE(drive(
      [&] {
        network->gps(true);
        network->nav();
        network->life_sign("fusion");
      },
      [&] { return ear->status()->healthy && ear->status()->mode == NavMode::gps_aided; }));
  ASSERT_TRUE(
      drive([&] { network->gps(true); },
            [&] { return ear->active("nav_state_missing") && ear->active("service_missing:fusion"); }));
  EXPECT_TRUE(wait_until([&] { return ear->status()->mode == NavMode::none; }, 1.0));
  EXPECT_EQ(ear->status()->alignment, AlignmentPhase::none);
  MonitorEar late(network->participant());
  EXPECT_TRUE(drive([&] { network->gps(true); }, [&] { return late.active("nav_state_missing"); }, 3.0));
}

TEST(MonitorConfiguration, IsRefusedInOneLineBeforeAnythingStarts) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"gps.limit=3", "gps.limit"},
      {"gps.limit_s=-1", "gps.limit_s"},
      {"evaluation_hz=\"often\"", "evaluation_hz"},
      {R"(sensors=[{"name":"imu","kind":"imu"}])", "rate_hz"},
      {R"(sensors=[{"name":"imu","kind":"sonar","rate_hz":1}])", "kind"},
      {R"(services=[{"name":"a"},{"name":"a"}])", "services"},
  };
  for (const auto& [set, named] : wrong) {
    Process process("fathom-monitor", {"--config", kConfig, "--set", set});
    EXPECT_EQ(process.wait(), 2) << set;
    const std::string said = process.err();
    EXPECT_NE(said.find(named), std::string::npos) << set << " -> " << said;
    EXPECT_NE(said.find("monitor.json"), std::string::npos) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  }
  Process check("fathom-monitor", {"--config", kConfig, "--check"});
  EXPECT_EQ(check.wait(), 0) << check.err();
}

}  // namespace
}  // namespace fathom::test
