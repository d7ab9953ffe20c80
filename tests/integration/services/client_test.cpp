#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fathom/client.hpp>
#include <gtest/gtest.h>

#include "bus/participant.hpp"
#include "bus/writer.hpp"
#include "samples/nav_state.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"
#include "vehicle_network.hpp"

namespace fathom::test {
namespace {

const std::string kSource = source_dir();

ClientOptions options(std::uint32_t domain, const std::string& vehicle = "auv") {
  ClientOptions out;
  out.domain = domain;
  out.vehicle = vehicle;
  out.profiles_dir = kSource + "/deploy/dds";
  return out;
}

TEST(Client, GivesTheNewestStateByCallbackByValueAndByWaiting) {
  const SystemClock clock;
  VehicleNetwork network(184, clock);
  Client client(options(184));
  EXPECT_FALSE(client.latest().has_value());
  EXPECT_TRUE(std::isnan(client.age_s()));
  EXPECT_FALSE(client.wait_next(0.05).has_value());
  std::atomic<int> calls{0};
  std::atomic<std::uint64_t> last{0};
  client.on_nav_state([&](const NavState& state) {
    ++calls;
    last = state.header.sequence;
  });
  ASSERT_TRUE(wait_until([&] {
    network.nav();
    return calls >= 10;
  }));
  // Nothing is written any more: all views agree on the last one.
  EXPECT_TRUE(wait_until([&] { return last == network.last_sequence(); }));
  EXPECT_EQ(client.latest()->header.sequence, network.last_sequence());
  EXPECT_TRUE(client.wait_next(1.0).has_value());
  EXPECT_FALSE(client.wait_next(0.05).has_value()) << "already returned";
  EXPECT_TRUE(client.health().ok) << client.health().reason;
  EXPECT_NEAR(client.health().horizontal_95_m, 2.45, 0.01);
  EXPECT_TRUE(wait_until([&] { return client.age_s() > 0.5; }, 5.0));
  EXPECT_FALSE(client.health().ok);
  EXPECT_FALSE(client.health().fresh);
  EXPECT_NE(client.health().reason.find("old"), std::string::npos);
}

TEST(Client, TimeDoesNotGoBackWhenOneFusionTakesOverFromAnother) {
  const TimeNs now = SystemClock().utc_ns();
  bus::Participant participant(presence(184, "two_fusions"));
  bus::Writer<NavState> writer(participant);
  Client client(options(184));
  std::mutex mutex;
  std::vector<std::pair<std::string, DurationNs>> heard;
  client.on_nav_state([&](const NavState& state) {
    const std::lock_guard lock(mutex);
    heard.emplace_back(state.header.sensor.str(), (state.header.stamp_ns - now) / kNsPerMillisecond);
  });
  ASSERT_TRUE(wait_until([&] { return writer.matched_readers() == 1; }));
  const auto arrived = [&] {
    const std::lock_guard lock(mutex);
    return heard.size();
  };
  const auto say = [&](const Name& fusion, DurationNs stamp_ms) {
    NavState state;
    state.header.vehicle = "auv";
    state.header.sensor = fusion;
    state.header.stamp_ns = now + stamp_ms * kNsPerMillisecond;
    EXPECT_TRUE(writer.write(state));
  };
  say("leader", 1000);
  ASSERT_TRUE(wait_until([&] { return arrived() == 1; }));
  say("standby", 7000);
  ASSERT_TRUE(wait_until([&] { return arrived() == 2; }));
  say("leader", 2000);  // it had been held up, and goes on with what it had not said
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the client's reader keeps the newest alone
  say("leader", 6500);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  say("leader", 7500);
  ASSERT_TRUE(wait_until([&] { return arrived() >= 3; }));
  say("standby", 7500);  // what the other one has said
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  say("standby", 7500);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  say("standby", -30'000);  // UTC was set
  ASSERT_TRUE(wait_until([&] { return arrived() >= 4; }));
  const std::vector<std::pair<std::string, DurationNs>> expected{
      {"leader", 1000}, {"standby", 7000}, {"leader", 7500}, {"standby", -30'000}};
  const std::lock_guard lock(mutex);
  EXPECT_EQ(heard, expected);
}

TEST(Client, KeepsToOneVehicleAndPassesOnAlarmsAndTheMonitorsView) {
  const SystemClock clock;
  VehicleNetwork network(185, clock);
  Client named(options(185, "auv"));
  Client first(options(185, ""));
  std::atomic<int> alarms{0};
  named.on_alarm([&](const Alarm& alarm) { alarms += alarm.active ? 1 : 0; });
  ASSERT_TRUE(wait_until([&] {
    network.nav(NavMode::inertial, AlignmentPhase::aligned, 1.0, "other");
    return first.latest().has_value();
  }));
  ASSERT_TRUE(wait_until([&] {
    network.nav();
    network.monitor(true);
    network.alarm("gps_outage", true);
    return named.latest().has_value() && named.monitor().has_value() && alarms > 0;
  }));
  EXPECT_EQ(named.latest()->header.vehicle, Name("auv"));
  EXPECT_EQ(first.latest()->header.vehicle, Name("other")) << "the first one heard, and only that one";
  EXPECT_TRUE(named.monitor()->healthy);
}

TEST(Client, AHandlerMayReplaceItselfAndAReplacedOneIsNotCalledAgain) {
  const SystemClock clock;
  VehicleNetwork network(186, clock);
  Client client(options(186));
  std::atomic<int> once{0};
  std::atomic<int> after{0};
  auto big =
      std::make_shared<std::string>(1000, 'x');  // freed while it runs if the handler were not kept alive
  client.on_nav_state([&, big](const NavState&) {
    client.on_nav_state([&](const NavState&) { ++after; });
    once += static_cast<int>(big->size()) / 1000;
  });
  big.reset();
  ASSERT_TRUE(wait_until([&] {
    network.nav();
    return after >= 3;
  }));
  EXPECT_EQ(once, 1);
  client.on_nav_state(nullptr);
  const int seen = after;
  for (int i = 0; i < 5; ++i) network.nav();
  (void)client.wait_next(0.2);
  EXPECT_EQ(after, seen);
}

TEST(Client, RepeatsItsRouteForThoseWhoComeLaterAndRefusesOneThatNobodyCouldDraw) {
  const SystemClock clock;
  VehicleNetwork network(191, clock);
  ClientOptions named = options(191, "");
  named.name = "my_guidance";
  Client client(named);
  Route route{.active = 1,
              .waypoints = {{.name = "A", .latitude_rad = 0.6, .longitude_rad = 2.2},
                            {.name = "B", .latitude_rad = 0.61, .longitude_rad = 2.2, .depth_m = 5.0}}};
  client.publish_route(route);  // of a vehicle that is not known yet
  std::mutex mutex;
  std::vector<Route> heard;
  const bus::Reader<Route> late(network.participant(), [&](const Route& one, const bus::SampleInfo&) {
    const std::lock_guard lock(mutex);
    heard.push_back(one);
  });
  const auto heard_with = [&](std::size_t count, std::uint32_t active) {
    const std::lock_guard lock(mutex);
    return heard.size() >= count && heard.back().active == active;
  };
  ASSERT_TRUE(wait_until(
      [&] {
        network.nav();
        return heard_with(3, 1);  // it is said again and again
      },
      60.0));
  {
    const std::lock_guard lock(mutex);
    const Route& last = heard.back();
    EXPECT_EQ(last.header.vehicle, Name("auv"));
    EXPECT_EQ(last.header.sensor, Name("my_guidance"));
    EXPECT_GT(last.header.stamp_ns, heard.front().header.stamp_ns);
    EXPECT_GT(last.header.sequence, heard.front().header.sequence);
    EXPECT_EQ(last.mission_count, 2U);
    ASSERT_EQ(last.waypoints.size(), 2U);
    EXPECT_EQ(last.waypoints[1].name, Name("B"));
    EXPECT_EQ(last.waypoints[1].depth_m, 5.0);
  }
  // From a handler as well, which runs on a thread of the bus.
  route.active = 2;
  client.on_nav_state([&](const NavState&) { client.publish_route(route); });
  EXPECT_TRUE(wait_until(
      [&] {
        network.nav();
        return heard_with(4, 2);
      },
      60.0));
  client.on_nav_state(nullptr);
  route.waypoints[0].latitude_rad = kUnknown;
  try {
    client.publish_route(route);
    ADD_FAILURE() << "a waypoint nowhere";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("my_guidance: its position is not usable, expected"),
              std::string::npos)
        << error.what();
  }
  client.publish_route({});
  EXPECT_TRUE(wait_until([&] { return heard_with(5, 0); }, 60.0));
  const std::lock_guard lock(mutex);
  EXPECT_TRUE(heard.back().waypoints.empty()) << "it follows nothing any more";
}

TEST(ClientHealth, SaysWhatIsWrongFirst) {
  NavState good;
  good.mode = NavMode::dead_reckoning;
  good.alignment = AlignmentPhase::aligned;
  good.latitude_rad = 0.6;
  good.longitude_rad = 2.2;
  good.velocity_N_m_s = {1, 0, 0};
  good.q_NB = {1, 0, 0, 0};
  good.position_covariance_N_m2 = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  good.rpy_sigma_rad = {0.001, 0.001, 0.01};
  const HealthLimits limits;
  EXPECT_TRUE(judge(good, 0.1, limits).ok);
  EXPECT_EQ(judge(good, 0.1, limits).reason, "");

  struct Case {
    const char* says;
    double age_s;
    void (*spoil)(NavState&);
  };
  const Case cases[] = {
      {"0.60 s old", 0.6, [](NavState&) {}},
      {"mode aligning", 0.1, [](NavState& s) { s.mode = NavMode::aligning; }},
      {"mode none", 0.1, [](NavState& s) { s.mode = NavMode::none; }},
      {"not finite", 0.1, [](NavState& s) { s.longitude_rad = kUnknown; }},
      {"not finite", 0.1, [](NavState& s) { s.q_NB[2] = kUnknown; }},
      {"not aligned: phase fine", 0.1, [](NavState& s) { s.alignment = AlignmentPhase::fine; }},
      {"position is certain only", 0.1, [](NavState& s) { s.position_covariance_N_m2[0] = 1e4; }},
      {"position is certain only", 0.1, [](NavState& s) { s.position_covariance_N_m2[0] = kUnknown; }},
      {"heading is certain only", 0.1, [](NavState& s) { s.rpy_sigma_rad[2] = 0.5; }},
      {"heading is certain only", 0.1, [](NavState& s) { s.rpy_sigma_rad[2] = kUnknown; }},
  };
  for (const Case& item : cases) {
    NavState state = good;
    item.spoil(state);
    const NavHealth health = judge(state, item.age_s, limits);
    EXPECT_FALSE(health.ok) << item.says;
    EXPECT_NE(health.reason.find(item.says), std::string::npos) << health.reason;
  }
  EXPECT_FALSE(judge(good, kUnknown, limits).ok);
  EXPECT_FALSE(judge(std::nullopt, kUnknown, limits).heard);
  HealthLimits lenient;
  lenient.need_aligned = false;
  NavState fine = good;
  fine.alignment = AlignmentPhase::fine;
  EXPECT_TRUE(judge(fine, 0.1, lenient).ok);
}

TEST(GuidanceExample, RefusesUntilNavigationIsGoodThenSteersThenRefusesAgain) {
  const SystemClock clock;
  VehicleNetwork network(189, clock);
  std::mutex mutex;
  ServiceStatus last;
  bus::Reader<ServiceStatus> reader(network.participant(),
                                    [&](const ServiceStatus& status, const bus::SampleInfo&) {
                                      const std::lock_guard lock(mutex);
                                      last = status;
                                    });
  const auto seen = [&](ServiceState state, const std::string& says) {
    const std::lock_guard lock(mutex);
    return last.pid != 0 && last.state == state && last.text.find(says) != std::string::npos;
  };
  setenv("FATHOM_DDS_DIR", (kSource + "/deploy/dds").c_str(), 1);
  Process guidance("fathom-guidance-example",
                   {"--config", kSource + "/deploy/config/guidance_example.json", "--set", "bus.domain=189"});
  ASSERT_TRUE(wait_until([&] { return seen(ServiceState::starting, "No navigation state"); }))
      << guidance.err();
  const auto feed = [&](NavMode mode, AlignmentPhase phase, ServiceState state, const std::string& says) {
    return wait_until(
        [&] {
          network.nav(mode, phase);
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
          return seen(state, says);
        },
        8.0);
  };
  EXPECT_TRUE(feed(NavMode::aligning, AlignmentPhase::averaging, ServiceState::starting, "aligning"));
  EXPECT_TRUE(feed(NavMode::gps_aided, AlignmentPhase::aligned, ServiceState::healthy, ""));
  EXPECT_TRUE(wait_until([&] { return seen(ServiceState::degraded, "not steering"); }));
  guidance.kill(SIGINT);
  EXPECT_EQ(guidance.wait(), 0);
  EXPECT_NE(guidance.err().find("m to go"), std::string::npos) << guidance.err();
}

TEST(StatusCommand, ExitCodeAndJsonTellHealthyDegradedAndNoNavigation) {
  const SystemClock clock;
  VehicleNetwork network(190, clock);
  setenv("FATHOM_DDS_DIR", (kSource + "/deploy/dds").c_str(), 1);
  const auto run = [&](bool with_nav, bool healthy, std::vector<std::string> more) {
    std::vector<std::string> arguments{"status", "--domain", "190", "--timeout", with_nav ? "8" : "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto process = std::make_unique<Process>("fathom", arguments);
    (void)wait_until(
        [&] {
          if (with_nav) {
            network.nav();
            network.monitor(healthy);
            network.life_sign("fusion");
          }
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
          return !process->running();
        },
        20.0);
    return process;
  };
  const auto silent = run(false, false, {"--json"});
  EXPECT_EQ(silent->wait(), 2) << silent->err();
  EXPECT_NE(silent->out().find("\"condition\":\"no_navigation\""), std::string::npos) << silent->out();
  const auto good = run(true, true, {"--json"});
  EXPECT_EQ(good->wait(), 0) << good->out() << good->err();
  EXPECT_NE(good->out().find("\"mode\":\"gps_aided\""), std::string::npos) << good->out();
  const auto bad = run(true, false, {});
  EXPECT_EQ(bad->wait(), 1) << bad->out();
  EXPECT_NE(bad->out().find("degraded"), std::string::npos);
  EXPECT_EQ(bad->out().find('\x1b'), std::string::npos) << "no colours where there is no terminal";
}

}  // namespace
}  // namespace fathom::test
