#include <gtest/gtest.h>

#include "support/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

/// Velocity east after 15 s at rest with a DVL alone, when navigation was started with 1 m/s east and sure of
/// it.
double wrong_velocity_left(GateMode mode, double probability) {
  const SurveyRun run({.duration_s = 15.0, .wave_rad = 0.0});
  EngineConfig config = SurveyRun::config();
  config.groups = StateGroups{};
  SensorConfig dvl = config.sensors[1];
  dvl.gate_mode = mode;
  dvl.gate_probability = probability;
  dvl.robust = RobustKind::none;
  dvl.reacquire_s = 5.0;
  config.sensors = {dvl};
  config.alignment.mode = StartMode::given;
  FusionEngine engine(config);
  const Truth& truth = run.truth.front();
  InitialState start;
  start.latitude_rad = truth.latitude_rad;
  start.longitude_rad = truth.longitude_rad;
  start.altitude_m = truth.altitude_m;
  start.rpy_rad = truth.rpy_rad;
  start.velocity_N_m_s = {0.0, 1.0, 0.0};
  start.velocity_sigma_N_m_s = {0.01, 0.01, 0.01};
  start.attitude_sigma_rad = {1e-4, 1e-4, 1e-3};
  engine.start_from(start);
  for (const auto& sample : run.samples) test::feed(engine, sample);
  return engine.nav_state().velocity_N_m_s[1];
}

TEST(Reacquire, OneRowThatIsRefusedForeverIsBelievedThoughTheOthersPass) {
  EXPECT_NEAR(wrong_velocity_left(GateMode::per_component, 0.999), 0.0, 0.05);
}

TEST(Reacquire, NoGateIsTooTight) {
  EXPECT_NEAR(wrong_velocity_left(GateMode::whole, 0.5), 0.0, 0.05);
  EXPECT_NEAR(wrong_velocity_left(GateMode::per_component, 0.5), 0.0, 0.05);
}

}  // namespace
}  // namespace fathom::estimation
