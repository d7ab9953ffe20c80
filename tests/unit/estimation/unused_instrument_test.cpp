// What no part of the engine has a use for is told so at once, and leaves the work and the state alone.

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "estimation/navigator/setup.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

/// What came of a survey.
struct Outcome {
  NavState nav;
  std::uint64_t repeated_steps = 0;
  std::vector<Verdict> of_actuators;
};

/// A shaft and fins beside the instruments of the survey.
EngineConfig configuration() {
  EngineConfig config = SurveyRun::config();
  config.sensors.push_back(default_sensor(SourceKind::propulsion, "shaft"));
  config.sensors.push_back(default_sensor(SourceKind::fins, "fins"));
  return config;
}

template <class Sample>
Sample late(const char* sensor, const SampleHeader& newest) {
  Sample out;
  out.header = newest;
  out.header.sensor = sensor;
  out.header.stamp_ns -= 57'000'000;
  return out;
}

Outcome run(const EngineConfig& config, bool with_actuators) {
  const SurveyRun survey({.duration_s = 30.0});
  FusionEngine engine(config);
  Outcome out;
  int k = 0;
  for (const test::Sample& sample : survey.samples) {
    test::feed(engine, sample);
    const auto* imu = std::get_if<ImuSample>(&sample);
    if (imu != nullptr && with_actuators && ++k % 20 == 0) {
      PropulsionSample shaft = late<PropulsionSample>("shaft", imu->header);
      shaft.rpm = 300.0;
      engine.add(shaft);
      engine.add(late<FinsSample>("fins", imu->header));
    }
    for (Verdict verdict; engine.next_verdict(verdict);)
      if (verdict.source == SourceKind::propulsion || verdict.source == SourceKind::fins)
        out.of_actuators.push_back(verdict);
  }
  out.nav = engine.nav_state();
  out.repeated_steps = engine.repeated_steps();
  return out;
}

TEST(UnusedInstrument, IsToldSoOnceAndCostsNothing) {
  const Outcome with = run(configuration(), true);
  const Outcome without = run(configuration(), false);
  ASSERT_EQ(with.nav.mode, NavMode::gps_aided);
  ASSERT_GT(with.of_actuators.size(), 200U);
  EXPECT_EQ(with.of_actuators.size() % 2, 0U);
  for (const Verdict& one : with.of_actuators) {
    EXPECT_EQ(one.kind, VerdictKind::source_disabled);
    EXPECT_TRUE(one.is_final);
    EXPECT_EQ(one.revision, 0U);
  }
  EXPECT_EQ(with.repeated_steps, without.repeated_steps);
  EXPECT_EQ(with.nav.latitude_rad, without.nav.latitude_rad);
  EXPECT_EQ(with.nav.rpy_rad, without.nav.rpy_rad);
  EXPECT_EQ(with.nav.position_covariance_N_m2, without.nav.position_covariance_N_m2);
}

TEST(UnusedInstrument, ShaftThatTellsASpeedIsUsed) {
  EngineConfig config = configuration();
  for (SensorConfig& one : config.sensors)
    if (one.kind == SourceKind::propulsion) one.scale_m_s_per_rpm = 1.0 / 300.0;
  const Outcome out = run(config, true);
  int used = 0;
  for (const Verdict& one : out.of_actuators) {
    EXPECT_TRUE(one.source == SourceKind::propulsion || one.kind == VerdictKind::source_disabled);
    used += one.kind == VerdictKind::used ? 1 : 0;
  }
  EXPECT_GT(used, 50);
}

/// Whether the sensor of this number is.
bool unused(const EngineConfig& config, std::size_t number) {
  return estimation::Setup(config).unused[number];
}

TEST(UnusedInstrument, NoneIsWhereAVehicleModelOrADropNeedsThem) {
  EngineConfig config = configuration();
  const auto fins = config.sensors.size() - 1;
  EXPECT_TRUE(unused(config, fins));
  EXPECT_FALSE(unused(config, 0));
  EngineConfig modelled = config;
  modelled.vehicle_model.enabled = true;
  EXPECT_FALSE(unused(modelled, fins));
  EngineConfig dropped = config;
  dropped.alignment.mode = StartMode::air_drop;
  EXPECT_FALSE(unused(dropped, fins - 1));
}

}  // namespace
}  // namespace fathom::estimation
