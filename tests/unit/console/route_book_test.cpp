#include "console/view/route_book.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "console/view/vehicle_view.hpp"
#include "console/view/vehicle_view_json.hpp"
#include "unit/console/utc.hpp"

namespace fathom::console {
namespace {

/// A vehicle with programs that guide it, seen by a console with its own clock.
struct Voyage {
  VehicleView view{{"auv", 3, 0.7}};
  health::Instant now{kNsPerSecond, kUtc};

  void wait(double seconds) {
    now.monotonic_ns += from_seconds(seconds);
    now.utc_ns += from_seconds(seconds);
  }
  [[nodiscard]] Route route(const char* publisher = "guidance") const {
    Route out;
    out.header.vehicle = "auv";
    out.header.sensor = publisher;
    out.header.stamp_ns = now.utc_ns;
    out.active = 1;
    out.waypoints = {{.name = "A", .latitude_rad = 36.4 * kRadPerDeg, .longitude_rad = 187.5 * kRadPerDeg},
                     {.name = "<b>",
                      .latitude_rad = -36.5 * kRadPerDeg,
                      .longitude_rad = -127.5 * kRadPerDeg,
                      .depth_m = 5.0,
                      .speed_m_s = 1.5}};
    return out;
  }
  std::optional<std::string> say(const Route& route) { return view.add(route, now); }
  nlohmann::json tick() { return nlohmann::json::parse(tick_json(view.tick(now))); }
  /// The routes of the next tick that has them.
  nlohmann::json routes() {
    for (int i = 0; i < 10; ++i) {
      const auto json = tick();
      if (json.contains("routes")) return json["routes"];
    }
    ADD_FAILURE() << "ten ticks without routes";
    return {};
  }
};

TEST(Routes, TravelToThePageAsTheyWereSaid) {
  Voyage scene;
  EXPECT_TRUE(scene.routes().empty());
  Route said = scene.route();
  said.leg_start_latitude_rad = 36.3 * kRadPerDeg;
  said.leg_start_longitude_rad = 127.5 * kRadPerDeg;
  said.repeats = true;
  said.first_number = 7;
  said.mission_count = 20;
  EXPECT_FALSE(scene.say(said).has_value());
  scene.wait(0.25);
  const auto shown = scene.routes();
  ASSERT_EQ(shown.size(), 1U);
  EXPECT_EQ(shown[0]["publisher"], "guidance");
  EXPECT_EQ(shown[0]["active"], 1);
  EXPECT_EQ(shown[0]["repeats"], true);
  EXPECT_EQ(shown[0]["first_number"], 7);
  EXPECT_EQ(shown[0]["mission_count"], 20);
  EXPECT_EQ(shown[0]["old"], false);
  EXPECT_NEAR(shown[0]["age_s"].get<double>(), 0.25, 1e-6);
  EXPECT_NEAR(shown[0]["leg_start"][0].get<double>(), 36.3, 1e-8);
  const auto& points = shown[0]["points"];
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0][0], "A");
  EXPECT_NEAR(points[0][1].get<double>(), 36.4, 1e-8);
  EXPECT_NEAR(points[0][2].get<double>(), -172.5, 1e-8) << "on the map longitude ends at 180";
  EXPECT_TRUE(points[0][3].is_null()) << "a depth that is unknown";
  EXPECT_EQ(points[1][0], "<b>");
  EXPECT_NEAR(points[1][2].get<double>(), -127.5, 1e-8);
  EXPECT_EQ(points[1][3], 5.0);
  EXPECT_EQ(points[1][4], 1.5);
}

TEST(Routes, AreSaidWhenTheyChangeAndNowAndThen) {
  Voyage scene;
  (void)scene.routes();
  EXPECT_FALSE(scene.tick().contains("routes"));
  (void)scene.say(scene.route());
  EXPECT_TRUE(scene.tick().contains("routes")) << "a new one at once";
  (void)scene.say(scene.route());
  EXPECT_FALSE(scene.tick().contains("routes")) << "the same again";
  Route next = scene.route();
  next.active = 2;
  (void)scene.say(next);
  EXPECT_TRUE(scene.tick().contains("routes")) << "the next waypoint at once";
}

TEST(Routes, GrowOldUnlessTheyAreRepeated) {
  Voyage scene;
  for (int i = 0; i < 10; ++i) {
    (void)scene.say(scene.route());
    scene.wait(1.0);
    EXPECT_EQ(scene.routes()[0]["old"], false);
  }
  scene.wait(2.5);
  EXPECT_EQ(scene.routes()[0]["old"], true);
  EXPECT_NEAR(scene.routes()[0]["age_s"].get<double>(), 3.5, 1e-6);
  (void)scene.say(scene.route());
  EXPECT_EQ(scene.routes()[0]["old"], false) << "its publisher is back";
  scene.wait(601.0);
  EXPECT_TRUE(scene.routes().empty()) << "of no use to anybody";
}

TEST(Routes, WhatWaitedOnTheNetworkIsAsOldAsItsStamp) {
  Voyage scene;
  Route waited = scene.route();
  waited.header.stamp_ns -= from_seconds(40.0);
  (void)scene.say(waited);
  EXPECT_EQ(scene.routes()[0]["old"], true);
  EXPECT_NEAR(scene.routes()[0]["age_s"].get<double>(), 40.0, 1e-6);
  waited.header.stamp_ns += from_seconds(1.0);
  (void)scene.say(waited);
  EXPECT_EQ(scene.routes()[0]["old"], false) << "it is being repeated: that its clock is late is not its age";
  Route ahead = scene.route("ahead");
  ahead.header.stamp_ns += from_seconds(1e6);
  (void)scene.say(ahead);
  EXPECT_EQ(scene.routes()[0]["publisher"], "ahead");
  EXPECT_EQ(scene.routes()[0]["age_s"], 0.0);
}

TEST(Routes, OfNothingOrOfAnotherVehicleAreNotShown) {
  Voyage scene;
  Route other = scene.route();
  other.header.vehicle = "other";
  EXPECT_FALSE(scene.say(other).has_value());
  Route nothing = scene.route();
  nothing.active = 0;
  nothing.waypoints.clear();
  EXPECT_FALSE(scene.say(nothing).has_value());
  EXPECT_TRUE(scene.routes().empty());
}

TEST(Routes, HostileOnesAreRefusedAndCountedByReason) {
  Voyage scene;
  Route bad = scene.route();
  bad.waypoints[0].latitude_rad = kUnknown;
  const auto fault = scene.say(bad);
  ASSERT_TRUE(fault.has_value());
  EXPECT_NE(fault->find("position"), std::string::npos) << *fault;
  EXPECT_NE(fault->find("expected"), std::string::npos) << *fault;
  bad = scene.route();
  bad.active = 99;
  EXPECT_TRUE(scene.say(bad).has_value());
  EXPECT_TRUE(scene.say(bad).has_value());
  EXPECT_TRUE(scene.routes().empty());
  for (std::size_t i = 0; i < RouteBook::kMostRoutes; ++i) {
    EXPECT_FALSE(scene.say(scene.route(("p" + std::to_string(i)).c_str())).has_value());
  }
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(scene.say(scene.route(("q" + std::to_string(i)).c_str())).has_value());
  }
  EXPECT_FALSE(scene.say(scene.route("p3")).has_value()) << "those who are there stay";
  EXPECT_EQ(scene.routes().size(), RouteBook::kMostRoutes);
  const auto& refused = scene.view.routes().refused();
  EXPECT_EQ(refused[static_cast<std::size_t>(RouteFault::position)], 1U);
  EXPECT_EQ(refused[static_cast<std::size_t>(RouteFault::active)], 2U);
  EXPECT_EQ(refused[RouteBook::kTooMany], 1000U);
  EXPECT_EQ(RouteBook::word(RouteBook::kTooMany), "too_many");
  scene.wait(601.0);
  EXPECT_FALSE(scene.say(scene.route("later")).has_value()) << "the forgotten leave room";
}

}  // namespace
}  // namespace fathom::console
