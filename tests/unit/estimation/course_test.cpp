// Heading from GPS velocity alone: found without help, and never surer than it is right.
#include <optional>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/navigator/navigator.hpp"
#include "support/vehicles/road_run.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using test::RoadRun;

struct Course {
  double aligned_at_s = kUnknown;
  int states = 0;  ///< on straights
  double worst_sigma = 0.0;
  double last_error_rad = 0.0;
  double last_sigma_rad = 0.0;
};

/// What an anemometer on the vehicle reads in a wind.
AirspeedSample airspeed(const Truth& truth, const Vector3d& wind_N_m_s) {
  AirspeedSample out;
  out.header = truth.header;
  out.header.sensor = "air0";
  out.true_airspeed_m_s = (geo::vec(truth.velocity_N_m_s) - wind_N_m_s).norm();
  return out;
}

/// How the published heading goes with that of the wheels, in a wind with an airspeed.
Course follow(const EngineConfig& config, const RoadRun& run,
              const std::optional<Vector3d>& wind_N_m_s = std::nullopt) {
  FusionEngine engine(config);
  Course out;
  std::size_t at = 0;
  for (const auto& sample : run.samples) {
    test::feed(engine, sample);
    if (!std::holds_alternative<ImuSample>(sample)) continue;
    const Truth& truth = run.truth[at++];
    if (wind_N_m_s && at % 5 == 0) engine.add(airspeed(truth, *wind_N_m_s));
    const NavState& nav = engine.nav_state();
    if (nav.header.stamp_ns != truth.header.stamp_ns || !known(nav.latitude_rad)) continue;
    const double t = to_seconds(truth.header.stamp_ns - RoadRun::kEpochNs);
    if (!known(out.aligned_at_s) && nav.alignment == AlignmentPhase::aligned) out.aligned_at_s = t;
    if (!RoadRun::straight(t)) continue;
    ++out.states;
    out.last_error_rad = std::remainder(nav.rpy_rad[2] - truth.rpy_rad[2], 2.0 * M_PI);
    out.last_sigma_rad = nav.rpy_sigma_rad[2];
    out.worst_sigma = std::max(out.worst_sigma, std::abs(out.last_error_rad) / out.last_sigma_rad);
  }
  return out;
}

TEST(CourseHeading, IsFoundInMotionAndAsGoodAsItSays) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Course course = follow(RoadRun::config(), RoadRun({.seed = seed}));
    EXPECT_GT(course.states, 3000) << "seed " << seed;
    EXPECT_LT(course.aligned_at_s, 60.0) << "seed " << seed;
    EXPECT_LT(course.worst_sigma, 3.0) << "seed " << seed;
    EXPECT_LT(course.last_sigma_rad, 0.5 * kRadPerDeg) << "seed " << seed;
  }
}

/// (KF-5) A speed without direction moves the wind, which says nothing of where the vehicle points.
TEST(CourseHeading, AnAirspeedInAnUnknownWindTellsNothingOfIt) {
  EngineConfig config = RoadRun::config();
  config.alignment.in_motion_heading_sigma_rad = 20.0 * kRadPerDeg;
  config.alignment.in_motion_speed_m_s = 3.0;  // no current of water: the wheels do not crab in the wind
  config.groups.current = true;
  config.states.current_sigma_m_s = 8.0;
  config.sensors.push_back(default_sensor(SourceKind::airspeed, "air0"));
  config.sensors.back().sigma = {0.3, 0.3, 0.3};
  const Vector3d wind_N_m_s(6.0, -8.0, 0.0);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const RoadRun straight({.duration_s = 11.0, .seed = seed});
    const Course with = follow(config, straight, wind_N_m_s);
    const Course without = follow(config, straight);
    EXPECT_GT(with.last_sigma_rad, 0.95 * without.last_sigma_rad) << "seed " << seed;
    EXPECT_LT(follow(config, RoadRun({.seed = seed}), wind_N_m_s).worst_sigma, 3.0) << "seed " << seed;
  }
}

TEST(CourseHeading, ABiasThatSettlesIsOnlyALieWhereNobodySaysSo) {
  const RoadRun run({.settling_rad_s = 0.5 * kRadPerDeg});
  EXPECT_GT(follow(RoadRun::config(), run).worst_sigma, 3.0);
  EngineConfig settling = RoadRun::config();
  settling.imu.gyro_bias_settling_rad_s = 0.5 * kRadPerDeg;
  settling.imu.bias_settling_time_s = 25.0;
  const Course course = follow(settling, run);
  EXPECT_LT(course.worst_sigma, 3.0);
  EXPECT_LT(course.aligned_at_s, 100.0);
  // Once the unit has settled nothing is left of the doubt.
  EXPECT_LT(course.last_sigma_rad, 0.5 * kRadPerDeg);
}

TEST(CourseHeading, OfTheWheelsWhereTheUnitIsMountedAskew) {
  const RoadRun run({.mount_pitch_rad = 0.6 * kRadPerDeg, .mount_yaw_rad = -1.5 * kRadPerDeg});
  EngineConfig config = RoadRun::config();
  config.groups.mount_angles = true;
  config.constraints.non_holonomic.enabled = true;
  const Course body = follow(config, run);
  EXPECT_NEAR(body.last_error_rad, 1.5 * kRadPerDeg, 0.4 * kRadPerDeg);
  config.output_axes = OutputAxes::wheels;
  const Course wheels = follow(config, run);
  EXPECT_LT(std::abs(wheels.last_error_rad), 0.3 * kRadPerDeg);
  EXPECT_LT(wheels.worst_sigma, 3.0);
  EXPECT_LT(wheels.last_sigma_rad, body.last_sigma_rad);
  // Without the constraint nothing tells where the wheels point.
  config.constraints.non_holonomic.enabled = false;
  const Course free = follow(config, run);
  config.output_axes = OutputAxes::body;
  EXPECT_EQ(free.last_error_rad, follow(config, run).last_error_rad);
}

/// (NOISE-2)
TEST(SettlingBias, AddsItsWholeVarianceHoweverTheTimeIsCut) {
  EngineConfig config = RoadRun::config();
  config.imu.gyro_bias_settling_rad_s = 3e-3;
  config.imu.bias_settling_time_s = 20.0;
  const estimation::Setup setup(config);
  Navigator navigator(setup);
  navigator.start(InitialState{}, RoadRun::kEpochNs);
  const int gyro = setup.index.of(Group::gyro_bias);
  const int accel = setup.index.of(Group::accel_bias);
  ErrorFilter whole(setup.index.size());
  ErrorFilter parts(setup.index.size());
  navigator.drive_biases(whole, 0.0, 15.0);
  for (int i = 0; i < 60; ++i) navigator.drive_biases(parts, 0.25 * i, 0.25);
  EXPECT_NEAR(parts(gyro + 2, gyro + 2), whole(gyro + 2, gyro + 2),
              1e-12 * whole(gyro + 2, gyro + 2) + 1e-20);
  EXPECT_NEAR(whole(gyro, gyro), 9e-6 * (1.0 - std::exp(-1.5)), 1e-15);
  EXPECT_EQ(whole(accel, accel), 0.0);
  navigator.drive_biases(whole, 15.0, 1e4);
  EXPECT_NEAR(whole(gyro, gyro), 9e-6, 1e-15);
}

/// (OUT-3)
TEST(OutputAxesOfTheWheels, CovarianceIsThatOfTheTurnedAxes) {
  EngineConfig config = RoadRun::config();
  config.groups.mount_angles = true;
  config.constraints.non_holonomic.enabled = true;
  config.constraints.non_holonomic.mounting_rpy_rad = {0.1, -0.2, 0.4};
  config.output_axes = OutputAxes::wheels;
  const estimation::Setup setup(config);
  const auto mount = static_cast<std::size_t>(setup.index.of(Group::mount_angles));
  test::Normal normal(3);
  FilterState state;
  state.nav.q_NB = geo::from_rpy({0.2, -0.3, 1.1});
  state.x[mount] = 0.02;
  state.x[mount + 1] = -0.03;
  // Attitude and mount are known together: P = A A'.
  Eigen::Matrix<double, 5, 5> root;
  for (int i = 0; i < 5; ++i)
    for (int k = 0; k < 5; ++k) root(i, k) = normal(0.01);
  const Eigen::Matrix<double, 5, 5> p = root * root.transpose();
  const auto place = [&](int i) { return i < 3 ? 6 + i : static_cast<int>(mount) + i - 3; };
  ErrorFilter filter(setup.index.size());
  for (int i = 0; i < 5; ++i)
    for (int k = 0; k <= i; ++k) filter.set(place(i), place(k), p(i, k));
  Navigator navigator(setup);
  navigator.start(InitialState{}, RoadRun::kEpochNs);
  const auto rpy = [&](const FilterState& at) {
    navigator.replace(at, filter);
    return geo::to_rpy(navigator.output_attitude().q_NO);
  };
  // How each error moves what is published, by differences of the correction that would take it off.
  Eigen::Matrix<double, 3, 5> j;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 5; ++i) {
    std::array<double, kMaxStates> x{};
    FilterState moved[2] = {state, state};
    for (int side = 0; side < 2; ++side) {
      x[static_cast<std::size_t>(place(i))] = side == 0 ? -kStep : kStep;
      remove_error(x, setup.index.size(), moved[side]);
    }
    j.col(i) = (rpy(moved[1]) - rpy(moved[0])) / (2.0 * kStep);
  }
  const Vector3d published = rpy(state);
  const Vector3d expected = (j * p * j.transpose()).diagonal().cwiseSqrt();
  EXPECT_LT((navigator.rpy_sigma_rad() - expected).norm(), 1e-3 * expected.norm());
  const Vector3d forward = geo::to_matrix(geo::from_rpy(published)).col(0);
  const Vector3d along =
      navigator.output_attitude().along(geo::to_matrix(state.nav.q_NB).transpose() * forward);
  EXPECT_LT((along - Vector3d::UnitX()).norm(), 1e-9);
}

}  // namespace
}  // namespace fathom::estimation
