// What the catalogue's models, and models of one's own, mean for a vehicle.
#include <fstream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/fusion/fusion_config.hpp"
#include "config/vehicle/catalogue.hpp"
#include "config/vehicle/provenance.hpp"
#include "unit/config/vehicle_file.hpp"

namespace fathom::config {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class VehicleOfModels : public Vehicle {};

TEST_F(VehicleOfModels, AUnitOfNoModelIsNotTakenForATacticalOne) {
  const auto imu = [&] { return load<FusionConfig>("fusion").engine.imu; };
  const estimation::ImuConfig tactical;
  instrument("imu").erase("model");
  instrument("imu")["protocol"] = "vectornav";
  const estimation::ImuConfig module = imu();
  EXPECT_GT(module.gyro_bias_sigma_rad_s, 100.0 * tactical.gyro_bias_sigma_rad_s);
  EXPECT_GT(module.accel_bias_sigma_m_s2, 2.0 * tactical.accel_bias_sigma_m_s2);
  EXPECT_GT(module.gyro_scale_sigma, 2.0 * tactical.gyro_scale_sigma);
  EXPECT_GT(module.accel_scale_sigma, 2.0 * tactical.accel_scale_sigma);
  EXPECT_GT(module.gyro_misalignment_sigma_rad, 2.0 * tactical.gyro_misalignment_sigma_rad);
  EXPECT_GT(module.accel_misalignment_sigma_rad, 2.0 * tactical.accel_misalignment_sigma_rad);
  EXPECT_GT(module.angle_random_walk_rad_sqrt_s, 2.0 * tactical.angle_random_walk_rad_sqrt_s);
  EXPECT_GT(module.velocity_random_walk_m_s_sqrt_s, 2.0 * tactical.velocity_random_walk_m_s_sqrt_s);
  instrument("imu")["fusion"] = {{"gyro_scale_sigma", 1e-4}};
  EXPECT_DOUBLE_EQ(imu().gyro_scale_sigma, 1e-4) << "what the vehicle says stays";
}

TEST_F(VehicleOfModels, WhatAModelOfOnesOwnLeavesOutIsThatOfAClass) {
  const char* const walk = "angle_random_walk_deg_sqrt_h";
  std::filesystem::create_directories(folder / "catalogue");
  write("catalogue/own.json",
        {{"title", "Own"},
         {"kind", "imu"},
         {"fusion", {{walk, 0.01}}},
         {"figures",
          {{std::string("fusion.") + walk, {{"says", "0.01 deg/sqrt(h)"}, {"source", "Own, page 1"}}}}}});
  instrument("imu")["model"] = "own";
  instrument("imu")["protocol"] = "vectornav";
  const estimation::ImuConfig own = load<FusionConfig>("fusion").engine.imu;
  const estimation::ImuConfig tactical;
  EXPECT_GT(own.gyro_bias_sigma_rad_s, 100.0 * tactical.gyro_bias_sigma_rad_s);
  EXPECT_LT(own.angle_random_walk_rad_sqrt_s, tactical.angle_random_walk_rad_sqrt_s);
  EXPECT_DOUBLE_EQ(own.velocity_random_walk_m_s_sqrt_s, tactical.velocity_random_walk_m_s_sqrt_s);
  std::map<std::string, Origin> from;
  for (const ConfigKind& kind : config_kinds()) {
    if (kind.name != "fusion") continue;
    for (const Provenance& one : provenance(kind, with_vehicle({}, vehicle(), "fusion")))
      from[one.key] = one.origin;
  }
  const Origin& bias = from.at("engine.imu.gyro_bias_sigma_deg_h");
  EXPECT_EQ(bias.layer, Layer::standard);
  EXPECT_EQ(bias.file, "class of factory-calibrated MEMS modules");
  EXPECT_EQ(from.at(std::string("engine.imu.") + walk).layer, Layer::catalogue);
}

TEST_F(VehicleOfModels, EveryModelMakesAVehicle) {
  for (const std::string& model : catalogue_models()) {
    SCOPED_TRACE(model);
    const CatalogueEntry entry = load_catalogue_entry(catalogue_file(model, "", ""));
    json one = {{"name", "tried"}, {"kind", to_string(entry.kind)},
                {"model", model},  {"protocol", entry.protocol.empty() ? "vectornav" : entry.protocol},
                {"rate_hz", 5.0},  {"port", {{"type", "serial"}, {"path", "/dev/ttyUSB9"}}}};
    if (entry.kind != SourceKind::heading) one["position_m"] = {0, 0, 0};
    if (entry.kind == SourceKind::imu || entry.kind == SourceKind::dvl) one["mounting_rpy_deg"] = {0, 0, 0};
    if (entry.kind == SourceKind::depth) one["bridge"] = {{"unit", "psi"}};
    file["instruments"] = json::array({instrument("imu"), one});
    EXPECT_EQ(complaint(), "");
  }
  EXPECT_GE(catalogue_models().size(), 30U);
}

TEST_F(VehicleOfModels, EachFigureOfTheCatalogueNamesItsSource) {
  const std::string good = catalogue_file("vectornav_vn100", "", "");
  std::ifstream in(good);
  const json entry = json::parse(in);
  const auto said = [&](json changed) -> std::string {
    try {
      (void)load_catalogue_entry(write("tried.json", changed));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  ASSERT_EQ(said(entry), "");
  json changed = entry;
  changed["figures"].erase("fusion.angle_random_walk_deg_sqrt_h");
  EXPECT_THAT(said(changed), HasSubstr("fusion.angle_random_walk_deg_sqrt_h among them, with its source"));
  changed = entry;
  changed["figures"]["baud"]["source"] = "";
  EXPECT_THAT(said(changed), HasSubstr("figures.baud.source"));
  changed = entry;
  changed["figures"]["rate_hz"] = entry["figures"]["baud"];
  EXPECT_THAT(said(changed), HasSubstr("figures.rate_hz"));
}

}  // namespace
}  // namespace fathom::config
