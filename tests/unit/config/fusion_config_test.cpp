#include "config/fusion/fusion_config.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "config/registry.hpp"
#include "samples/kinds.hpp"
#include "support/paths.hpp"

namespace fathom::config {
namespace {

// A file in the temporary folder that goes with the object.
class File {
 public:
  explicit File(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("fathom-fusion-config-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".json")) {
    std::ofstream(path_) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string with_engine(const std::string& engine) {
  return R"({"vehicle": "thor", "engine": {"imu": {}, "sensors": []})" +
         (engine.empty() ? "" : ", " + engine) + "}";
}

std::string sensor(const std::string& text) {
  return R"({"engine": {"imu": {}, "sensors": [)" + text + "]}}";
}

std::string error_of(const std::string& text) {
  const File file(text);
  try {
    static_cast<void>(load_service_config<FusionConfig>({file.path(), {}}));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FusionConfig, TurnsTheUnitsOfDataSheetsIntoSi) {
  const File file(R"({"vehicle": "thor", "imu_sensor": "imu1", "ownership_strength": 7,
    "start": {"mode": "given", "sigma": {"attitude_deg": [1, 2, 3]},
              "state": {"stamp_ns": 1700000000000000001, "latitude_deg": 36.0, "longitude_deg": -127.5,
                        "altitude_m": 18.5, "rpy_deg": [1, 2, 90]}},
    "engine": {"configuration": "gps_ins15", "groups": {"dvl_bias": true},
      "imu": {"angle_random_walk_deg_sqrt_h": 0.6, "velocity_random_walk_m_s_sqrt_h": 0.6, "gyro_bias_sigma_deg_h": 36},
      "sensors": [{"sensor": "dvl0", "kind": "dvl", "lever_B_m": [1, 2, 3], "mounting_rpy_deg": [0, 0, 45]},
                  {"sensor": "compass", "kind": "heading", "sigma_deg": [2, 2, 2]}]}})");
  const auto loaded = load_service_config<FusionConfig>({file.path(), {"engine.horizon_s=7"}});
  const FusionConfig& config = loaded.value;
  EXPECT_EQ(config.imu_sensor, "imu1");
  EXPECT_EQ(config.ownership_strength, 7);
  EXPECT_NEAR(config.engine.imu.angle_random_walk_rad_sqrt_s, 0.01 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(config.engine.imu.velocity_random_walk_m_s_sqrt_s, 0.01, 1e-15);
  EXPECT_NEAR(config.engine.imu.gyro_bias_sigma_rad_s, 0.01 * kRadPerDeg, 1e-15);
  ASSERT_EQ(config.engine.sensors.size(), 2U);
  EXPECT_NEAR(config.engine.sensors[0].mounting_rpy_rad[2], 45.0 * kRadPerDeg, 1e-15);
  EXPECT_EQ(config.engine.sensors[0].lever_B_m[2], 3.0);
  EXPECT_NEAR(config.engine.sensors[1].sigma[0], 2.0 * kRadPerDeg, 1e-15);
  EXPECT_TRUE(config.engine.groups.dvl_bias);
  EXPECT_FALSE(config.engine.groups.dvl_scale);

  const estimation::EngineConfig engine = engine_config(config);
  EXPECT_EQ(engine.vehicle, "thor");
  EXPECT_EQ(engine.alignment.mode, estimation::StartMode::given);
  EXPECT_EQ(engine.horizon_s, 7.0);
  EXPECT_EQ(engine.validate(), "");
  const estimation::InitialState state = initial_state(config);
  EXPECT_EQ(state.stamp_ns, 1'700'000'000'000'000'001);
  EXPECT_NEAR(state.latitude_rad, 36.0 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(state.rpy_rad[2], 90.0 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(state.attitude_sigma_rad[2], 3.0 * kRadPerDeg, 1e-15);
}

TEST(FusionConfig, SensorsTakeTheDefaultsOfTheirKind) {
  const File file(R"({"engine": {"imu": {}, "sensors": [
    {"sensor": "d", "kind": "dvl", "lever_B_m": [0, 0, 0], "mounting_rpy_deg": [0, 0, 0]},
    {"sensor": "g", "kind": "gps", "lever_B_m": [0, 0, 0]}]}})");
  const FusionConfig config = load_service_config<FusionConfig>({file.path(), {}}).value;
  EXPECT_EQ(config.engine.sensors[0].robust, estimation::RobustKind::student_t);
  EXPECT_EQ(config.engine.sensors[0].sigma, estimation::default_sensor(SourceKind::dvl, "d").sigma);
  EXPECT_EQ(config.engine.sensors[1].sigma, estimation::default_sensor(SourceKind::gps, "g").sigma);
  EXPECT_EQ(config.engine.sensors[1].robust, estimation::RobustKind::none);
  // Nothing said about states: those of the named configuration "standard".
  EXPECT_TRUE(config.engine.groups.dvl_scale);
}

// What the schema says of a kind, and what the loader does with it.
TEST(FusionConfig, EachKindKnowsTheKeysThatTheSchemaLeavesIt) {
  const auto kind = std::find_if(config_kinds().begin(), config_kinds().end(),
                                 [](const ConfigKind& each) { return each.name == "fusion"; });
  const auto schema = nlohmann::json::parse(kind->schema());
  const auto& items = schema["properties"]["engine"]["properties"]["sensors"]["items"];
  std::size_t kinds = 0;
  for_each_aiding_kind([&](auto row) {
    ++kinds;
    nlohmann::json forbidden;
    for (const auto& rule : items["allOf"]) {
      if (rule["if"]["properties"]["kind"]["const"] == row.kWord) forbidden = rule["then"]["properties"];
    }
    for (const auto& [key, property] : items["properties"].items()) {
      nlohmann::json value = property.value("default", nlohmann::json());
      for (const auto& rule : items["allOf"]) {
        const auto& own = rule["then"]["properties"];
        if (value.is_null() && own.contains(key) && own[key] != false) value = own[key]["default"];
      }
      if (value.is_null()) continue;
      nlohmann::json one = {{"sensor", "a"}, {"kind", row.kWord}};
      for (const char* needed : {"lever_B_m", "mounting_rpy_deg"}) {
        if (!forbidden.contains(needed) || forbidden[needed] != false) one[needed] = {0, 0, 0};
      }
      one[key] = value;
      const std::string answer = error_of(sensor(one.dump()));
      const bool refused = forbidden.contains(key) && forbidden[key] == false;
      const std::string expected =
          refused ? "no such key where kind is " + std::string(row.kWord) : "no error";
      EXPECT_THAT(answer, testing::HasSubstr(expected)) << row.kWord << " " << key;
    }
  });
  EXPECT_EQ(kinds, items["properties"]["kind"]["enum"].size());
}

TEST(FusionConfig, AVehicleOnWheelsEstimatesWhatItsConstraintNeedsUnlessToldOtherwise) {
  const auto groups_of = [](const std::string& engine) {
    const File file(R"({"engine": {"imu": {}, "sensors": [], )" + engine + "}}");
    return load_service_config<FusionConfig>({file.path(), {}}).value.engine.groups;
  };
  constexpr const char* kWheels = R"("constraints": {"non_holonomic": {"enabled": true}})";
  const auto on_wheels = groups_of(R"("configuration": "gps_ins15", )" + std::string(kWheels));
  EXPECT_TRUE(on_wheels.accel_scale && on_wheels.mount_angles && on_wheels.mount_lever);
  const auto told = groups_of(R"("groups": {"mount_lever": false}, )" + std::string(kWheels));
  EXPECT_TRUE(told.accel_scale && told.mount_angles && !told.mount_lever);
  const auto none =
      groups_of(R"("configuration": "gps_ins15", "constraints": {"non_holonomic": {"enabled": false}})");
  EXPECT_FALSE(none.accel_scale || none.mount_angles || none.mount_lever);
}

TEST(FusionConfig, HashFollowsEveryEffectiveValue) {
  const File file(with_engine(""));
  const std::string plain = load_service_config<FusionConfig>({file.path(), {}}).hash;
  EXPECT_EQ(plain, load_service_config<FusionConfig>({file.path(), {"engine.horizon_s=5"}}).hash);
  EXPECT_NE(plain, load_service_config<FusionConfig>({file.path(), {"engine.horizon_s=6"}}).hash);
  EXPECT_NE(plain, load_service_config<FusionConfig>({file.path(), {"vehicle=other"}}).hash);
}

struct Bad {
  const char* name;
  std::string text;
  const char* message;
};

class BadFusionConfig : public testing::TestWithParam<Bad> {};

TEST_P(BadFusionConfig, IsNamedByFileKeyValueAndExpectation) {
  EXPECT_THAT(error_of(GetParam().text), testing::HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadFusionConfig,
    testing::Values(
        Bad{"no_engine", R"({})", "engine: is missing"},
        Bad{"unknown_key", R"({"engin": {}})", "engin: is {}, expected no such key"},
        Bad{"given_without_state", R"({"start": {"mode": "given"}, "engine": {"imu": {}, "sensors": []}})",
            "start.state: is null, expected the state to start from"},
        Bad{"state_without_heading",
            R"({"start": {"state": {"latitude_deg": 1, "longitude_deg": 2, "altitude_m": 0}}, "engine": {"imu": {}, "sensors": []}})",
            "start.state.rpy_deg: is missing"},
        Bad{"mode", R"({"start": {"mode": "sideways"}, "engine": {"imu": {}, "sensors": []}})",
            "start.mode: is \"sideways\", expected one of at_rest"},
        Bad{"no_kind", sensor(R"({"sensor": "a"})"), "engine.sensors.0.kind: is missing"},
        Bad{"kind", sensor(R"({"sensor": "a", "kind": "sonar"})"),
            "engine.sensors.0.kind: is \"sonar\", expected one of gps"},
        Bad{"no_lever", sensor(R"({"sensor": "a", "kind": "gps"})"),
            "engine.sensors.0.lever_B_m: is missing"},
        Bad{"no_mounting", sensor(R"({"sensor": "a", "kind": "dvl", "lever_B_m": [0, 0, 0]})"),
            "engine.sensors.0.mounting_rpy_deg: is missing"},
        Bad{"wrong_unit", sensor(R"({"sensor": "a", "kind": "heading", "sigma_m": [1, 1, 1]})"),
            "engine.sensors.0.sigma_m: is [1,1,1], expected no such key where kind is heading; it is known "
            "where kind is one of gps, depth, usbl"},
        Bad{"beams_of_a_gps",
            sensor(R"({"sensor": "a", "kind": "gps", "lever_B_m": [0, 0, 0], "use_beams": true})"),
            "engine.sensors.0.use_beams: is true, expected no such key where kind is gps; it is known where "
            "kind "
            "is one of dvl"},
        Bad{"antennas_of_a_depth",
            sensor(R"({"sensor": "a", "kind": "depth", "lever_B_m": [0, 0, 0], "two_antenna": true})"),
            "engine.sensors.0.two_antenna: is true, expected no such key where kind is depth; it is known "
            "where "
            "kind is one of heading"},
        Bad{"gate_of_fins", sensor(R"({"sensor": "a", "kind": "fins", "gate_probability": 0.9})"),
            "engine.sensors.0.gate_probability: is 0.9, expected no such key where kind is fins; it is known "
            "where kind is one of gps, dvl, depth, heading, usbl, airspeed, propulsion"},
        Bad{"imu_as_aiding", sensor(R"({"sensor": "a", "kind": "imu"})"),
            "engine.sensors.0.kind: is \"imu\", expected one of gps"},
        Bad{"two_numbers", sensor(R"({"sensor": "a", "kind": "gps", "lever_B_m": [0, 0]})"),
            "engine.sensors.0.lever_B_m: is [0,0], expected an array of 3"},
        Bad{"twice", sensor(R"({"sensor": "a", "kind": "airspeed"}, {"sensor": "a", "kind": "airspeed"})"),
            "expected each name once"},
        Bad{"range", R"({"engine": {"imu": {"nominal_rate_hz": 0}, "sensors": []}})",
            "engine.imu.nominal_rate_hz: is 0, expected a number from 1 to 2000"},
        Bad{"across_fields", R"({"engine": {"imu": {"max_gap_s": 5, "lost_gap_s": 1}, "sensors": []}})",
            "engine.imu.lost_gap_s: is 1, expected at least imu.max_gap_s, which is 5"},
        Bad{"given_nothing", R"({"engine": {"imu": {}, "sensors": [], "snapshot_interval_s": 9}})",
            "engine.snapshot_interval_s: is 9, expected at most horizon_s, which is 5"},
        Bad{"groups", R"({"engine": {"imu": {}, "sensors": [], "groups": {"dvl_scale_xyz": true}}})",
            "engine.groups.dvl_scale_xyz"},
        Bad{"configuration", R"({"engine": {"imu": {}, "sensors": [], "configuration": "best"}})",
            "engine.configuration: is \"best\", expected one of gps_ins15"}),
    [](const auto& info) { return info.param.name; });

TEST(FusionConfig, EveryShippedFileLoads) {
  const std::filesystem::path folder = std::filesystem::path(test::source_dir()) / "deploy/config";
  EXPECT_NO_THROW(
      static_cast<void>(load_service_config<FusionConfig>({(folder / "fusion.json").string(), {}})));
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "solve")) {
    ++count;
    EXPECT_NO_THROW(static_cast<void>(load_service_config<FusionConfig>({entry.path().string(), {}})))
        << entry.path();
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace fathom::config
