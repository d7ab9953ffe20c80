// What a log tells goes into the file of the vehicle, where the same values are read from again.
#include <map>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "cli/commission/patch.hpp"
#include "geo/so3.hpp"

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;

Json vehicle() {
  return Json::parse(R"({"name": "auv", "instruments": [
    {"name": "spare", "kind": "gps", "enabled": false, "position_m": [9, 9, 9]},
    {"name": "imu", "kind": "imu", "rate_hz": 100.0, "position_m": [1.0, 0.5, -0.25], "mounting_rpy_deg": [0, 0, 0]},
    {"name": "gps", "kind": "gps", "position_m": [0, 0, 0]},
    {"name": "dvl", "kind": "dvl", "position_m": [0, 0, 0], "mounting_rpy_deg": [0, 0, 0]}]})");
}

std::map<std::string, Json> by_key(const std::vector<Change>& changes) {
  std::map<std::string, Json> out;
  for (const Change& change : changes) out[change.key] = change.value;
  return out;
}

TEST(VehiclePatch, NothingFoundChangesNothing) {
  EXPECT_TRUE(vehicle_changes_of({}, vehicle()).empty());
}

TEST(VehiclePatch, LeversBecomePositions) {
  commission::Patch patch;
  patch.gps_lever_B_m = Eigen::Vector3d(0.25, -0.5, 0.75);
  const auto changes = by_key(vehicle_changes_of(patch, vehicle()));
  ASSERT_EQ(changes.size(), 1U) << "the GPS that is left out stays as it is";
  EXPECT_EQ(changes.at("instruments.2.position_m"), Json::parse("[1.25, 0.0, 0.5]"));
}

TEST(VehiclePatch, MountingRateNoiseAndLatencyHaveTheirKeys) {
  commission::Patch patch;
  patch.imu_rate_hz = 200.0;
  patch.C_BI = geo::to_matrix(geo::from_rpy(Eigen::Vector3d(std::numbers::pi, 0.0, 0.0)));
  patch.angle_random_walk = std::numbers::pi / 180.0 / 60.0;
  patch.dvl_latency_s = 0.125;
  const Json before = vehicle();
  const std::vector<Change> changes = vehicle_changes_of(patch, before);
  const Json after = patched(before, changes);
  EXPECT_DOUBLE_EQ(after["instruments"][1]["rate_hz"].get<double>(), 200.0);
  EXPECT_NEAR(std::abs(after["instruments"][1]["mounting_rpy_deg"][0].get<double>()), 180.0, 1e-9);
  EXPECT_DOUBLE_EQ(after["instruments"][1]["fusion"]["angle_random_walk_deg_sqrt_h"].get<double>(), 1.0);
  EXPECT_DOUBLE_EQ(after["instruments"][3]["fusion"]["latency_s"].get<double>(), 0.125);
  EXPECT_EQ(after["instruments"][2], before["instruments"][2]);
  for (const Change& change : changes) {
    if (change.key == "instruments.1.rate_hz") {
      EXPECT_DOUBLE_EQ(change.was.get<double>(), 100.0);
    } else if (change.key == "instruments.3.fusion.latency_s") {
      EXPECT_TRUE(change.was.is_null());
    }
  }
}

TEST(VehiclePatch, WhatIsNotInTheVehicleIsNotWritten) {
  commission::Patch patch;
  patch.depth_latency_s = 0.1;
  patch.heading_latency_s = 0.1;
  EXPECT_TRUE(vehicle_changes_of(patch, vehicle()).empty());
}

}  // namespace
}  // namespace fathom::cli
