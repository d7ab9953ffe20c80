#include "config/fusion/fusion_config.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fathom::config {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

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

std::string sensor(const std::string& text) {
  return R"({"engine": {"imu": {}, "sensors": [)" + text + "]}}";
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
            "engine.sensors.0.sigma_m: is [1,1,1], expected the key sigma_deg"},
        Bad{"two_numbers", sensor(R"({"sensor": "a", "kind": "gps", "lever_B_m": [0, 0]})"),
            "engine.sensors.0.lever_B_m: is [0,0], expected an array of 3"},
        Bad{"twice", sensor(R"({"sensor": "a", "kind": "airspeed"}, {"sensor": "a", "kind": "airspeed"})"),
            "expected each name once"},
        Bad{"range", R"({"engine": {"imu": {"nominal_rate_hz": 0}, "sensors": []}})",
            "engine.imu.nominal_rate_hz: is 0, expected a number from 1 to 2000"},
        Bad{"across_fields", R"({"engine": {"imu": {"max_gap_s": 5, "lost_gap_s": 1}, "sensors": []}})",
            "engine.imu.lost_gap_s: is"},
        Bad{"groups", R"({"engine": {"imu": {}, "sensors": [], "groups": {"dvl_scale_xyz": true}}})",
            "engine.groups.dvl_scale_xyz"},
        Bad{"configuration", R"({"engine": {"imu": {}, "sensors": [], "configuration": "best"}})",
            "engine.configuration: is \"best\", expected one of gps_ins15"}),
    [](const auto& info) { return info.param.name; });

TEST(FusionConfig, EveryShippedFileLoads) {
  const std::filesystem::path folder = std::filesystem::path(FATHOM_SOURCE_DIR) / "deploy/config";
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
