#include <gtest/gtest.h>

#include "estimation/aiding/non_holonomic.hpp"
#include "samples/forecast.hpp"
#include "samples/uncertainty.hpp"
#include "support/vehicles/road_run.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

/// Horizontal error at the end of a run whose only instrument beside the inertial unit, GPS, ends at 50 s.
/// The vehicle moves along its own axis, as a car does.
double end_error_m(const ConstraintsConfig& constraints, const SurveyRun& run) {
  EngineConfig config = SurveyRun::config();
  config.groups = StateGroups{};
  config.groups.mount_angles = true;
  config.sensors.resize(1);
  config.alignment.heading_source = HeadingSource::given;
  config.alignment.given_heading_rad = 1.12;
  config.constraints = constraints;
  FusionEngine engine(config);
  for (const auto& sample : run.samples) test::feed(engine, sample);
  const NavState& state = engine.nav_state();
  const Truth& truth = run.truth.back();
  const Eigen::Vector3d error =
      geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                        {state.latitude_rad, state.longitude_rad, state.altitude_m});
  return error.head<2>().norm();
}

TEST(Constraints, WheelsHoldTheTrackWhenGpsEnds) {
  SurveyRun::Options options;
  options.duration_s = 180.0;
  options.accel_bias_m_s2 = 0.03;
  options.gyro_bias_rad_s = 5e-5;
  const SurveyRun run(options);
  ConstraintsConfig none;
  ConstraintsConfig wheels;
  wheels.non_holonomic.enabled = true;
  wheels.non_holonomic.lateral_sigma_m_s = wheels.non_holonomic.vertical_sigma_m_s = 0.05;
  const double free_m = end_error_m(none, run);
  const double held_m = end_error_m(wheels, run);
  EXPECT_GT(free_m, 30.0);
  EXPECT_LT(held_m, 0.2 * free_m) << free_m;
}

TEST(Constraints, SlipThatLastsIsNotLearntAwayTenTimesASecond) {
  const StateIndex index{StateGroups{}};
  FilterState state;
  state.nav.v_N_m_s = {10.0, 0.0, 0.0};
  const AidingState aiding(index, state, Eigen::Vector3d::Zero(), kUnknown);
  NonHolonomicConfig wheels;
  wheels.rate_hz = 10.0;
  wheels.lateral_sigma_m_s = 0.2;
  wheels.vertical_sigma_m_s = 0.1;
  EXPECT_EQ(NonHolonomic(aiding, wheels).noise(), Eigen::Vector2d(0.2, 0.1));
  wheels.slip_time_s = 0.05;
  EXPECT_EQ(NonHolonomic(aiding, wheels).noise(), Eigen::Vector2d(0.2, 0.1));
  wheels.slip_time_s = 1.6;
  EXPECT_NEAR((NonHolonomic(aiding, wheels).noise() - Eigen::Vector2d(0.8, 0.4)).norm(), 0.0, 1e-12);
}

TEST(Constraints, AWrongConstraintIsWeighedDown) {
  // The vehicle dives at up to 0.35 m/s: constant depth with a heave of 1 cm/s is wrong there, and must not
  // take the rest with it.
  SurveyRun::Options options;
  const SurveyRun run(options);
  ConstraintsConfig level;
  level.constant_depth.enabled = true;
  level.constant_depth.sigma_m_s = 0.01;
  EXPECT_LT(end_error_m(level, run), 2.0 * end_error_m({}, run) + 5.0);
}

/// What was forecast when GPS ended, and what the estimate then came to.
struct Outage {
  double forecast_95_m = kUnknown;
  double reached_95_m = kUnknown;
};

Outage outage(const ConstraintsConfig& constraints, const test::RoadRun& run, double from_s, double for_s) {
  EngineConfig config = test::RoadRun::config();
  config.groups.mount_angles = true;
  config.constraints = constraints;
  FusionEngine engine(config);
  Outage out;
  for (const auto& sample : run.samples) {
    const double t = to_seconds(test::header(sample).stamp_ns - test::RoadRun::kEpochNs);
    if (t >= from_s && !known(out.forecast_95_m)) out.forecast_95_m = engine.forecast_horizontal_95_m(for_s);
    if (t >= from_s + for_s) break;
    if (t < from_s || std::holds_alternative<ImuSample>(sample)) test::feed(engine, sample);
  }
  out.reached_95_m = horizontal_95_m(engine.nav_state().position_covariance_N_m2);
  return out;
}

// (FC-1, FC-3)
TEST(Constraints, AForecastReckonsWithWheels) {
  const test::RoadRun run({});
  ConstraintsConfig wheels;
  wheels.non_holonomic.enabled = true;
  wheels.non_holonomic.lateral_sigma_m_s = wheels.non_holonomic.vertical_sigma_m_s = 0.2;
  for (const double from_s : {80.0, 90.0, 100.0}) {
    for (const double for_s : {20.0, 50.0}) {
      const Outage held = outage(wheels, run, from_s, for_s);
      // As sure as the estimate comes to be, though nobody knows the turns to come.
      EXPECT_GT(held.forecast_95_m, 0.9 * held.reached_95_m) << from_s << " " << for_s;
      EXPECT_LT(held.forecast_95_m, 1.5 * held.reached_95_m) << from_s << " " << for_s;
      if (for_s > 40.0) {
        EXPECT_LT(held.forecast_95_m, 0.4 * outage({}, run, from_s, for_s).forecast_95_m) << from_s;
      }
    }
  }
}

TEST(Constraints, AForecastReckonsWithAVehicleThatKeepsItsDepth) {
  const test::RoadRun run({.duration_s = 80.0});
  const auto vertical_10m_s = [&](bool keeps) {
    EngineConfig config = test::RoadRun::config();
    config.constraints.constant_depth.enabled = keeps;
    config.forecast_limits = {{"vertical_10m", 10.0}};
    FusionEngine engine(config);
    for (const auto& sample : run.samples) test::feed(engine, sample);
    Forecast forecast;
    engine.fill(forecast);
    return forecast.limits[0].time_to_limit_s;
  };
  EXPECT_GT(vertical_10m_s(true), 2.0 * vertical_10m_s(false));
}

}  // namespace
}  // namespace fathom::estimation
