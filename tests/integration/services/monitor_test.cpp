#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/paths.hpp"
#include "support/process.hpp"
#include "vehicle_network.hpp"

namespace fathom::test {
namespace {

const std::string kConfig = source_dir() + "/deploy/config/monitor.json";

/// The real fathom-monitor in its own process, a vehicle around it, and an ear for what it says.
class MonitorTest : public ::testing::Test {
 protected:
  void start(std::uint32_t domain, std::vector<std::string> sets, const Clock& clock) {
    std::vector<std::string> arguments{"--config", kConfig};
    sets.push_back("bus.domain=" + std::to_string(domain));
    journal = std::filesystem::temp_directory_path() /
              ("fathom-monitor-test-" + std::to_string(getpid()) + "-" + std::to_string(domain) + ".jsonl");
    std::filesystem::remove(journal);
    metrics_port = 19464 + static_cast<int>(domain);
    sets.push_back("journal.path=" + journal.string());
    sets.push_back("metrics.port=" + std::to_string(metrics_port));
    sets.push_back(R"(sensors=[{"name":"gps","kind":"gps","rate_hz":10,"missing_s":30}])");
    for (const std::string& set : sets) {
      arguments.push_back("--set");
      arguments.push_back(set);
    }
    setenv("FATHOM_DDS_DIR", (source_dir() + "/deploy/dds").c_str(), 1);
    network = std::make_unique<VehicleNetwork>(domain, clock);
    ear = std::make_unique<MonitorEar>(network->participant());
    command_line = arguments;
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
    std::filesystem::remove(journal);
  }
  /// Every line of the journal as JSON; fails the test when one is none.
  [[nodiscard]] std::vector<nlohmann::json> journal_lines() const {
    std::vector<nlohmann::json> out;
    std::ifstream file(journal);
    for (std::string line; std::getline(file, line);) {
      out.push_back(nlohmann::json::parse(line, nullptr, false));
      EXPECT_FALSE(out.back().is_discarded()) << line;
    }
    return out;
  }
  [[nodiscard]] bool journalled(const std::string& event, const std::string& alarm) const {
    const auto lines = journal_lines();
    return std::any_of(lines.begin(), lines.end(), [&](const nlohmann::json& line) {
      return line["event"] == event && line.value("alarm", "") == alarm;
    });
  }

  SystemClock clock;
  std::unique_ptr<VehicleNetwork> network;
  std::unique_ptr<MonitorEar> ear;
  std::unique_ptr<Process> monitor;
  std::vector<std::string> command_line;
  std::filesystem::path journal;
  int metrics_port = 0;
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

TEST_F(MonitorTest, TheJournalSurvivesKillNineAndAnIncompleteLine) {
  start(184, {"services=[]", "navigation.expected=false", "gps.limit_s=1.0"}, clock);
  ASSERT_TRUE(drive([&] { network->gps(true); }, [&] { return ear->status()->gps_outage_s == 0.0; }));
  ASSERT_TRUE(drive([&] { network->gps(false); }, [&] { return ear->active("gps_outage"); }));
  EXPECT_TRUE(wait_until([&] { return journalled("raised", "gps_outage"); }, 2.0));
  monitor->kill(SIGKILL);
  EXPECT_EQ(monitor->wait(), 128 + SIGKILL);
  std::ofstream(journal, std::ios::app) << R"({"time_utc":"2026-01-01T00:00:00.000Z","event":"cle)";
  monitor = std::make_unique<Process>("fathom-monitor", command_line);
  ASSERT_TRUE(drive([&] { network->gps(true); },
                    [&] { return monitor->err().find("was incomplete") != std::string::npos; }))
      << monitor->err();
  // Still latched, though the new monitor never saw it; the fixes since have ended it.
  ASSERT_TRUE(drive([&] { network->gps(true); },
                    [&] { return ear->alarm("gps_outage").has_value() && !ear->active("gps_outage"); }));
  EXPECT_TRUE(wait_until([&] { return journal_lines().size() >= 5; }, 2.0));
  EXPECT_FALSE(ear->alarm("gps_outage")->acknowledged);
  const auto lines = journal_lines();
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_EQ(lines[0]["event"], "started");
  EXPECT_EQ(lines[1]["event"], "raised");
  EXPECT_EQ(lines[2]["event"], "repaired");
  EXPECT_EQ(lines[3]["event"], "started");
  EXPECT_EQ(lines[4]["event"], "cleared");
  monitor->kill(SIGTERM);
  EXPECT_EQ(monitor->wait(), 0);
  EXPECT_EQ(journal_lines().back()["event"], "stopped");
}

TEST_F(MonitorTest, AnOutageGoesOnOverKillNine) {
  start(188, {"services=[]", "navigation.expected=false", "gps.limit_s=1.0", "gps.warning_s=2.0"}, clock);
  ASSERT_TRUE(drive([&] { network->gps(true); }, [&] { return ear->status()->healthy; }));
  const TimeNs lost_ns = clock.monotonic_ns();
  ASSERT_TRUE(drive([&] { network->gps(false); },
                    [&] { return ear->active("gps_outage") && ear->status()->gps_outage_s > 3.0; }));
  monitor->kill(SIGKILL);
  EXPECT_EQ(monitor->wait(), 128 + SIGKILL);
  ear = std::make_unique<MonitorEar>(network->participant());
  monitor = std::make_unique<Process>("fathom-monitor", command_line);
  bool ever_healthy = false;
  ASSERT_TRUE(drive([&] { network->gps(false); },
                    [&] {
                      ever_healthy = ever_healthy || (ear->status() && ear->status()->healthy);
                      return ear->status() && ear->status()->gps_outage_active && ear->active("gps_outage");
                    }));
  EXPECT_FALSE(ever_healthy);
  EXPECT_EQ(ear->status()->gps_outage_count, 1u);
  EXPECT_NEAR(ear->status()->gps_outage_s, to_seconds(clock.monotonic_ns() - lost_ns), 1.5);
  const auto lines = journal_lines();
  EXPECT_EQ(std::count_if(lines.begin(), lines.end(),
                          [](const nlohmann::json& line) {
                            return line.value("alarm", "") == "gps_outage" && line["event"] == "cleared";
                          }),
            0);
  ASSERT_TRUE(drive([&] { network->gps(true); }, [&] { return ear->status()->healthy; }));
  EXPECT_EQ(ear->status()->gps_outage_count, 1u);
}

TEST_F(MonitorTest, ADiskThatFailsAgainIsSaidAgain) {
  start(189, {"services=[]", "navigation.expected=false"}, clock);
  const std::filesystem::path books = journal.string() + ".outages";
  const std::filesystem::path in_the_way = books.string() + ".new";
  const auto complaints = [&] {
    const std::string log = monitor->err();
    int out = 0;
    for (std::size_t at = 0; (at = log.find("cannot be written", at)) != std::string::npos; ++at) ++out;
    return out;
  };
  const auto drive_until = [&](const std::function<bool()>& condition) {
    return drive([&] { network->gps(true); }, condition, 60.0);
  };
  for (int time = 1; time <= 2; ++time) {
    std::filesystem::remove(books);
    ASSERT_TRUE(drive_until([&] { return std::filesystem::exists(books); })) << monitor->err();
    // The monitor may be about to rename a file of that name.
    ASSERT_TRUE(drive_until([&] {
      std::error_code taken;
      return std::filesystem::create_directory(in_the_way, taken);
    }));
    ASSERT_TRUE(drive_until([&] { return complaints() == time; })) << monitor->err();
    std::filesystem::remove(in_the_way);
  }
  std::filesystem::remove(books);
}

TEST_F(MonitorTest, ADiskThatHangsSilencesNothing) {
  start(198, {"services=[]", "navigation.expected=false", "gps.limit_s=1.0"}, clock);
  const std::filesystem::path books = journal.string() + ".outages";
  const std::filesystem::path hanging = books.string() + ".new";
  const auto drive_until = [&](bool fix, const std::function<bool()>& condition) {
    return drive([&] { network->gps(fix); }, condition, 60.0);
  };
  ASSERT_TRUE(drive_until(true, [&] { return std::filesystem::exists(books); })) << monitor->err();
  // A file that nobody reads hangs whoever opens it to write. The monitor may be about to rename its own.
  ASSERT_TRUE(drive_until(true, [&] { return mkfifo(hanging.c_str(), 0600) == 0; }));
  EXPECT_TRUE(drive_until(true, [&] { return ear->active("journal_failed"); }));
  EXPECT_TRUE(drive_until(false, [&] { return ear->active("gps_outage"); }));
  EXPECT_FALSE(journalled("raised", "gps_outage"));
  const int reader = open(hanging.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  EXPECT_TRUE(drive_until(
      false, [&] { return journalled("raised", "gps_outage") && !ear->active("journal_failed"); }));
  close(reader);
  std::filesystem::remove(books);
}

TEST_F(MonitorTest, ATakenPortAndAnImpossibleJournalAreSaidAndTheMonitorGoesOn) {
  const int taken = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(19464 + 185);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(bind(taken, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(taken, 1), 0);
  start(185, {"services=[]", "navigation.expected=false"}, clock);
  ASSERT_TRUE(drive([&] { network->gps(true); }, [&] { return ear->active("metrics_unavailable"); }));
  EXPECT_EQ(ear->alarm("metrics_unavailable")->severity, Severity::notice);
  EXPECT_NE(ear->alarm("metrics_unavailable")->text.find(std::to_string(metrics_port)), std::string::npos);
  EXPECT_TRUE(drive([&] { network->gps(true); }, [&] { return ear->status()->healthy; }));
  close(taken);
  monitor->kill(SIGTERM);
  EXPECT_EQ(monitor->wait(), 0) << monitor->err();
  command_line.insert(command_line.end(), {"--set", "journal.path=/dev/null"});
  monitor = std::make_unique<Process>("fathom-monitor", command_line);
  ASSERT_TRUE(drive([&] { network->gps(true); }, [&] { return ear->active("journal_failed"); }));
  EXPECT_TRUE(monitor->says("regular file")) << monitor->err();
}

TEST_F(MonitorTest, ASecondWriterIsNamedByServiceProcessAndHost) {
  start(186, {"services=[]", "navigation.expected=false"}, clock);
  VehicleNetwork rogue(186, clock, "rogue");
  ASSERT_TRUE(drive(
      [&] {
        network->gps(true);
        rogue.gps(true);
      },
      [&] { return ear->active("second_writer:gps"); }));
  const std::string text = ear->alarm("second_writer:gps")->text;
  const std::string process = "(process " + std::to_string(getpid()) + " on host ";
  EXPECT_NE(text.find("test_vehicle " + process), std::string::npos) << text;
  EXPECT_NE(text.find("rogue " + process), std::string::npos) << text;
}

TEST_F(MonitorTest, AnotherFusionThatIsHeardInsteadIsNamedWithTheOneBefore) {
  start(187, {R"(services=[{"name":"fusion"}])"}, clock);
  network->life_sign("fusion");
  ASSERT_TRUE(drive(
      [&] {
        network->nav();
        network->life_sign("fusion");
      },
      [&] { return ear->status() && ear->status()->mode == NavMode::gps_aided; }));
  bus::Participant rogue(presence(187, "fusion_b"));
  bus::WriterOptions stronger;
  stronger.ownership_strength = 1000;
  bus::Writer<NavState> rival(rogue, stronger);
  NavState state;
  state.mode = NavMode::gps_aided;
  ASSERT_TRUE(drive(
      [&] {
        network->nav();
        network->life_sign("fusion");
        state.header.vehicle = "auv";
        state.header.sensor = "fusion_b";
        state.header.stamp_ns = clock.utc_ns();
        rival.write(state);
      },
      [&] { return ear->active("nav_writer_unexpected") && ear->alarm("nav_writer_changed"); }));
  const std::string text = ear->alarm("nav_writer_changed")->text;
  const std::string process = " (process " + std::to_string(getpid()) + " on host ";
  EXPECT_EQ(text.find("The navigation state comes from fusion_b" + process), 0U) << text;
  EXPECT_NE(text.find("before it came from test_vehicle" + process), std::string::npos) << text;
  EXPECT_FALSE(ear->status()->healthy);
}

TEST_F(MonitorTest, APositionOrderedFarAwayIsAnAlarmThatNamesWhoOrderedIt) {
  start(188, {"services=[]"}, clock);
  ASSERT_TRUE(drive([&] { network->nav(); },
                    [&] { return ear->status() && ear->status()->mode == NavMode::gps_aided; }));
  bus::Participant rogue(presence(188, "anybody"));
  bus::Writer<Command> orders(rogue);
  ASSERT_TRUE(wait_until([&] { return orders.matched_readers() > 0; }));
  Command order;
  order.kind = CommandKind::set_position;
  order.latitude_rad = -0.6;
  order.longitude_rad = -1.0;
  order.sigma_m = 0.1;
  const auto give = [&](bool confirmed) {
    order.header.vehicle = "auv";
    order.header.sensor = "anybody";
    order.header.stamp_ns = clock.utc_ns();
    order.confirmed = confirmed;
    orders.write(order);
  };
  give(false);
  ASSERT_TRUE(drive([&] { network->nav(); }, [&] { return ear->alarm("position_order_held").has_value(); }));
  EXPECT_FALSE(ear->alarm("position_order_far"));
  give(true);
  ASSERT_TRUE(drive([&] { network->nav(); }, [&] { return ear->alarm("position_order_far").has_value(); }));
  const Alarm alarm = *ear->alarm("position_order_far");
  EXPECT_EQ(alarm.severity, Severity::critical);
  EXPECT_FALSE(alarm.acknowledged);
  EXPECT_EQ(alarm.text.find("anybody has ordered and confirmed a position "), 0U) << alarm.text;
  EXPECT_GT(alarm.value, 1e7);
}

TEST(MonitorConfiguration, IsRefusedInOneLineBeforeAnythingStarts) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"gps.limit=3", "gps.limit"},
      {"gps.limit_s=-1", "gps.limit_s"},
      {"evaluation_hz=\"often\"", "evaluation_hz"},
      {R"(sensors=[{"name":"imu","kind":"imu"}])", "rate_hz"},
      {R"(sensors=[{"name":"imu","kind":"sonar","rate_hz":1}])", "kind"},
      {R"(services=[{"name":"a"},{"name":"a"}])", "services"},
      {"metrics.port=70000", "metrics.port"},
      {"metrics.address=everywhere", "metrics.address"},
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
