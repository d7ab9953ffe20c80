// What is said of the estimator's configuration goes with what it is.
#include <cstring>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/field_check.hpp"
#include "estimation/description/engine.hpp"
#include "support/unit_of_key.hpp"

namespace fathom::estimation {
namespace {

/// A walk that remembers every field and which bytes of the struct are described.
template <class T>
class Remember {
 public:
  template <class M>
  FieldRef<M> field(std::string key, M T::*member, std::string sentence) {
    const auto offset = static_cast<std::size_t>(reinterpret_cast<const char*>(&(probe.*member)) -
                                                 reinterpret_cast<const char*>(&probe));
    for (std::size_t i = 0; i < sizeof(M); ++i) described[offset + i] = true;
    infos.push_back(std::make_unique<FieldInfo>());
    infos.back()->key = std::move(key);
    infos.back()->sentence = std::move(sentence);
    return {*infos.back(), std::make_shared<Rules<Leaf<M>>>()};
  }

  T probe{};
  std::vector<bool> described = std::vector<bool>(sizeof(T), false);
  std::vector<std::unique_ptr<FieldInfo>> infos;
};

template <class T>
class Description : public testing::Test {};

using Described =
    testing::Types<ImuConfig, StateGroups, StateModelConfig, SensorConfig, AlignmentConfig, StabilityConfig,
                   DropConfig, AltimeterConfig, NonHolonomicConfig, ConstantDepthConfig, ConstraintsConfig,
                   hydro::HydroCoefficients, VehicleModelConfig, ForecastLimitConfig, EngineConfig>;
TYPED_TEST_SUITE(Description, Described);

TYPED_TEST(Description, SaysWhatEachFieldIsAndInWhichUnit) {
  Remember<TypeParam> walk;
  describe(walk);
  std::set<std::string> keys;
  for (const auto& info : walk.infos) {
    EXPECT_TRUE(keys.insert(info->key).second) << info->key << " is described twice";
    EXPECT_GE(info->sentence.size(), 4U) << info->key << " has no sentence";
    EXPECT_EQ(info->unit, test::unit_of_key(info->key).value_or(info->unit)) << info->key;
  }
}

/// Members that other sections of the file tell, or other structs, in words of eight bytes.
template <class T>
constexpr std::size_t kToldElsewhere = 0;
template <>
constexpr std::size_t kToldElsewhere<DropConfig> = 2;  // heading_sigma_rad, speed_per_rpm
template <>
constexpr std::size_t kToldElsewhere<EngineConfig> = 2 * sizeof(std::string) / 8;  // vehicle, sensor

TYPED_TEST(Description, LeavesOutNoMember) {
  Remember<TypeParam> walk;
  describe(walk);
  std::size_t left_out = 0;
  for (std::size_t at = 0; at + 8 <= walk.described.size(); at += 8) {
    const auto from = walk.described.begin() + static_cast<std::ptrdiff_t>(at);
    if (std::none_of(from, from + 8, [](bool known) { return known; })) ++left_out;
  }
  EXPECT_EQ(left_out, kToldElsewhere<TypeParam>);
}

TEST(DescriptionOfGroups, LeavesOutNoSwitch) {
  Remember<StateGroups> walk;
  describe(walk);
  EXPECT_EQ(std::count(walk.described.begin(), walk.described.end(), false), 0);
}

TEST(Defaults, AreInsideTheirRanges) {
  EngineConfig config;
  EXPECT_EQ(config.validate(), "");
  for_each_aiding_kind([&](auto kind) {
    config.sensors = {default_sensor(kind.kSource, "one")};
    EXPECT_EQ(config.validate(), "") << kind.kWord;
  });
}

TEST(Configurations, AreNamedOnce) {
  std::set<std::string> names;
  for (const StateConfiguration& one : state_configurations()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    StateGroups groups;
    EXPECT_TRUE(named_state_groups(one.name, groups));
  }
  StateGroups groups;
  EXPECT_FALSE(named_state_groups("best", groups));
}

TEST(Configurations, MayHaveALabelOfTheirOwnInCode) {
  EngineConfig config;
  config.configuration = "hydro";
  EXPECT_EQ(config.validate(), "");
}

std::string refusal(void (*spoil)(EngineConfig&)) {
  EngineConfig config;
  config.sensors = {default_sensor(SourceKind::gps, "g"), default_sensor(SourceKind::dvl, "d")};
  spoil(config);
  return config.validate();
}

TEST(Refusal, NamesKeyValueAndExpectationInTheUnitOfTheFile) {
  using testing::HasSubstr;
  using C = EngineConfig;
  EXPECT_EQ(refusal([](C& c) { c.imu.nominal_rate_hz = 0.0; }),
            "imu.nominal_rate_hz: 0: expected a number from 1 to 2000");
  EXPECT_EQ(refusal([](C& c) { c.imu.mounting_rpy_rad[2] = 400.0 * kRadPerDeg; }),
            "imu.mounting_rpy_deg.2: 400: expected a number from -360 to 360");
  EXPECT_EQ(refusal([](C& c) { c.imu.lost_gap_s = 0.1; }),
            "imu.lost_gap_s: 0.1: expected at least imu.max_gap_s, which is 0.25");
  EXPECT_EQ(refusal([](C& c) { c.snapshot_interval_s = 20.0; }),
            "snapshot_interval_s: 20: expected at most horizon_s, which is 5");
  EXPECT_EQ(refusal([](C& c) { c.sensors[1].sensor = "g"; }),
            "sensors.1.sensor: g: expected each name once, but that fins may share one");
  EXPECT_THAT(refusal([](C& c) { c.sensors[1].kind = SourceKind::imu; }),
              HasSubstr("sensors.1.kind: 0: expected one of gps, dvl"));
  EXPECT_THAT(refusal([](C& c) { c.vehicle_model.enabled = true; }),
              HasSubstr("vehicle_model.coefficients.X_uu: 0: expected a negative number"));
  EXPECT_EQ(refusal([](C& c) { c.groups.dvl_scale_xyz = true; }),
            "groups.dvl_scale_xyz: true: expected false where dvl_scale is true");
  EXPECT_THAT(refusal([](C& c) { c.alignment.mode = StartMode::air_drop; }),
              HasSubstr("air_drop.slip_per_turn_m: missing: expected the vehicle's own value"));
  EXPECT_EQ(refusal([](C& c) { c.sensors.assign(25, c.sensors[0]); }), "sensors: 25: expected at most 24");
  EXPECT_EQ(refusal([](C& c) {
              c.forecast_limits.assign(9, {"a", 1.0});
            }),
            "forecast_limits: 9: expected at most 8");
  EXPECT_EQ(refusal([](C& c) { c.vehicle.clear(); }), "vehicle: : expected 1 to 31 characters");
}

}  // namespace
}  // namespace fathom::estimation
