#include "samples/status/route.hpp"

#include <functional>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace fathom {
namespace {

Route sound() {
  Route route;
  route.header.sensor = "guidance";
  route.waypoints = {
      {.name = "A", .latitude_rad = 0.6, .longitude_rad = 2.2, .depth_m = 5.0, .speed_m_s = 1.5},
      {.name = "", .latitude_rad = -1.5, .longitude_rad = -3.0}};
  return route;
}

TEST(RouteFault, AcceptsWhatGuidanceMayMean) {
  EXPECT_EQ(fault_of(sound()), RouteFault::none);
  Route over = sound();
  over.active = 2;
  EXPECT_EQ(fault_of(over), RouteFault::none) << "the last one is passed";
  Route nothing;
  nothing.header.sensor = "guidance";
  EXPECT_EQ(fault_of(nothing), RouteFault::none) << "it follows nothing";
  Route part = sound();
  part.first_number = 99;
  part.mission_count = 100;
  EXPECT_EQ(fault_of(part), RouteFault::none) << "the last two of a hundred";
  Route full = sound();
  full.waypoints.resize(Route::kMostWaypoints, full.waypoints[0]);
  EXPECT_EQ(fault_of(full), RouteFault::none);
}

TEST(RouteFault, NamesEachThingThatIsWrong) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  struct Case {
    RouteFault fault;
    std::function<void(Route&)> spoil;
  };
  const std::vector<Case> cases{
      {RouteFault::publisher, [](Route& r) { r.header.sensor = ""; }},
      {RouteFault::length, [](Route& r) { r.waypoints.resize(65, r.waypoints[0]); }},
      {RouteFault::length, [](Route& r) { r.first_number = 0; }},
      {RouteFault::length, [](Route& r) { r.mission_count = 1; }},
      {RouteFault::length,
       [](Route& r) {
         r.first_number = 0xFFFFFFFF;  // must not wrap round to something small
         r.mission_count = 100;
       }},
      {RouteFault::active, [](Route& r) { r.active = 3; }},
      {RouteFault::active, [](Route& r) { r.active = 0xFFFFFFFF; }},
      {RouteFault::position, [](Route& r) { r.waypoints[1].latitude_rad = kUnknown; }},
      {RouteFault::position, [](Route& r) { r.waypoints[0].latitude_rad = 1.6; }},
      {RouteFault::position, [](Route& r) { r.waypoints[0].longitude_rad = kInfinite; }},
      {RouteFault::position, [](Route& r) { r.waypoints[0].longitude_rad = -7.0; }},
      {RouteFault::position, [](Route& r) { r.waypoints[0].longitude_rad = 1e300; }},
      {RouteFault::position, [](Route& r) { r.leg_start_latitude_rad = 0.5; }},
      {RouteFault::motion, [](Route& r) { r.waypoints[0].depth_m = kInfinite; }},
      {RouteFault::motion, [](Route& r) { r.waypoints[0].depth_m = 20000; }},
      {RouteFault::motion, [](Route& r) { r.waypoints[0].speed_m_s = -1; }},
      {RouteFault::name, [](Route& r) { r.waypoints[1].name = "a\nb"; }},
      {RouteFault::name, [](Route& r) { r.header.sensor = "a\x1b[2J"; }},
  };
  std::set<RouteFault> seen;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Route route = sound();
    cases[i].spoil(route);
    EXPECT_EQ(fault_of(route), cases[i].fault) << "case " << i;
    EXPECT_FALSE(expectation(cases[i].fault).empty());
    seen.insert(cases[i].fault);
  }
  EXPECT_EQ(seen.size(), kRouteFaults - 1) << "each fault has a case";
}

TEST(RouteIntent, IsTheSameWhoeverSaidItAndWhen) {
  Route later = sound();
  later.header.sensor = "other";
  later.header.stamp_ns = 5;
  EXPECT_TRUE(same_intent(sound(), later)) << "unknown depths and all";
  const std::vector<std::function<void(Route&)>> changes{
      [](Route& r) { r.active = 1; },
      [](Route& r) { r.repeats = true; },
      [](Route& r) { r.first_number = 2; },
      [](Route& r) { r.mission_count = 9; },
      [](Route& r) { r.leg_start_latitude_rad = 0.1; },
      [](Route& r) { r.leg_start_longitude_rad = 0.1; },
      [](Route& r) { r.waypoints.pop_back(); },
      [](Route& r) { r.waypoints[0].name = "B"; },
      [](Route& r) { r.waypoints[0].latitude_rad += 1e-9; },
      [](Route& r) { r.waypoints[0].longitude_rad += 1e-9; },
      [](Route& r) { r.waypoints[1].depth_m = 0.0; },
      [](Route& r) { r.waypoints[0].speed_m_s = kUnknown; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Route changed = sound();
    changes[i](changed);
    EXPECT_FALSE(same_intent(sound(), changed)) << "change " << i;
  }
}

}  // namespace
}  // namespace fathom
