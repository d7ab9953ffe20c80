// Waypoints from a guidance program to the page, over DDS.
#include "samples/status/route.hpp"

#include <cmath>
#include <functional>

#include "base/units.hpp"
#include "bus/writer.hpp"
#include "console_fixture.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

using nlohmann::json;

class RouteTest : public ConsoleTest {
 protected:
  void open_page() {
    page = peer();
    page->say("GET /api/live HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
    ASSERT_TRUE(page->event("snapshot").has_value());
  }
  /// Reads the stream until it says so of the routes.
  bool shown(const std::function<bool(const json& routes)>& condition) {
    return wait_until(
        [&] {
          const auto tick = page->event("tick");
          if (tick && tick->contains("routes")) last = (*tick)["routes"];
          return condition(last);
        },
        kPatienceS);
  }
  std::unique_ptr<HttpPeer> page;
  json last = json::array();
};

TEST_F(RouteTest, WhatGuidanceFollowsIsOnThePageAndGrowsOldWhenItIsGone) {
  start_and_wait(30, {R"(map.waypoints=[{"name": "mark", "lat_deg": 1.0, "lon_deg": 2.0}])"});
  keep_navigating(true);
  const auto guide = [] {
    return std::make_unique<Process>(
        "fathom-guidance-example",
        std::vector<std::string>{"--config", source_dir() + "/deploy/config/guidance_example.json", "--set",
                                 "bus.domain=30", "--set", "waypoints.1.name=turn"});
  };
  auto guidance = guide();
  open_page();
  ASSERT_TRUE(shown([](const json& routes) { return routes.size() == 1; })) << guidance->err();
  const json route = last[0];
  EXPECT_EQ(route["publisher"], "guidance_example_client");
  EXPECT_EQ(route["active"], 0);
  EXPECT_EQ(route["repeats"], true);
  EXPECT_EQ(route["first_number"], 1);
  EXPECT_EQ(route["mission_count"], 4);
  ASSERT_EQ(route["points"].size(), 4U);
  EXPECT_EQ(route["points"][1][0], "turn");
  // 100 m north of where the vehicle was when guidance took over; the page has a millimetre.
  EXPECT_NEAR(route["leg_start"][0].get<double>(), 0.6 / kRadPerDeg, 1e-7);
  EXPECT_NEAR((route["points"][0][1].get<double>() - 0.6 / kRadPerDeg) * kRadPerDeg * 6.36e6, 100.0, 1.0);
  EXPECT_NEAR(route["points"][0][2].get<double>(), 2.2 / kRadPerDeg, 1e-7);
  EXPECT_EQ(route["points"][1][3], 5.0);
  EXPECT_EQ(route["points"][1][4], 1.5);
  EXPECT_EQ(json::parse(get("/api/session").body)["waypoints"][0]["name"], "mark") << "and the fixed ones";

  EXPECT_TRUE(shown([](const json& routes) { return routes.size() == 1 && routes[0]["old"] == false; }));
  guidance->kill(SIGKILL);
  EXPECT_EQ(guidance->wait(), 128 + SIGKILL);
  EXPECT_TRUE(shown([](const json& routes) { return routes.size() == 1 && routes[0]["old"] == true; }))
      << last.dump();
  guidance = guide();
  EXPECT_TRUE(shown([](const json& routes) { return routes.size() == 1 && routes[0]["old"] == false; }))
      << guidance->err();
  guidance->kill(SIGTERM);
  EXPECT_EQ(guidance->wait(), 0) << guidance->err();
}

TEST_F(RouteTest, HostileRoutesAreRefusedLoggedAndCountedByReason) {
  start_and_wait(31);
  std::mutex mutex;
  ServiceStatus status;
  const bus::Reader<ServiceStatus> ear(network->participant(),
                                       [&](const ServiceStatus& heard, const bus::SampleInfo&) {
                                         if (heard.header.sensor != Name("console")) return;
                                         const std::lock_guard lock(mutex);
                                         status = heard;
                                       });
  const auto counted = [&](const char* name) {
    const std::lock_guard lock(mutex);
    for (const ServiceCounter& one : status.counters) {
      if (one.name == Name(name)) return one.value > 0;
    }
    return false;
  };
  bus::Writer<Route> writer(network->participant());
  ASSERT_TRUE(wait_until([&] { return writer.matched_readers() > 0; }, kPatienceS));
  const auto write = [&](const char* publisher, const std::function<void(Route&)>& spoil) {
    Route route;
    route.header = network->header(publisher);
    route.waypoints = {{.name = "A", .latitude_rad = 0.6, .longitude_rad = 2.2}};
    spoil(route);
    EXPECT_TRUE(writer.write(route));
  };
  // Last 1 per key: each is repeated until it has been counted.
  const auto refused = [&](const char* counter, const std::function<void(Route&)>& spoil) {
    return wait_until(
        [&] {
          write("bad", spoil);
          std::this_thread::sleep_for(std::chrono::milliseconds(50));
          return counted(counter);
        },
        kPatienceS);
  };
  EXPECT_TRUE(refused("routes_refused_position", [](Route& r) { r.waypoints[0].latitude_rad = kUnknown; }));
  EXPECT_TRUE(refused("routes_refused_active", [](Route& r) { r.active = 4'000'000'000U; }));
  EXPECT_TRUE(refused("routes_refused_motion", [](Route& r) { r.waypoints[0].speed_m_s = -INFINITY; }));
  EXPECT_TRUE(refused("routes_refused_name", [](Route& r) { r.waypoints[0].name = "\x1b[2J"; }));
  EXPECT_TRUE(counted("routes_refused"));
  EXPECT_TRUE(
      console->says("refused a route from test_vehicle: its position is not usable, expected latitudes"))
      << console->err();
  open_page();
  write("good", [](Route&) {});
  ASSERT_TRUE(shown([&](const json& routes) { return routes.size() == 1; })) << last.dump();
  EXPECT_EQ(last[0]["publisher"], "good");
  EXPECT_EQ(console->err().find('\x1b'), std::string::npos) << "nothing of it reaches a terminal";
}

}  // namespace
}  // namespace fathom::test
