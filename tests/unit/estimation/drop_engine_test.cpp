#include <cmath>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "estimation/fusion_engine.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "sim/simulation.hpp"

namespace fathom::estimation {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr TimeNs kEpoch = 1'700'000'000 * kNsPerSecond;

sim::Scenario drop() {
  sim::Scenario out;
  out.vehicle.kind = sim::VehicleConfig::Kind::air_drop;
  out.environment.turbulence_m_s = 0.03;
  out.environment.water_depth_m = 500.0;
  out.start.latitude_rad = 0.6;
  out.start.longitude_rad = 2.0;
  out.start.depth_m = -380.0;
  out.start.speed_m_s = 61.7;
  out.start.rpy_rad = {6.0 * kDegree, -8.0 * kDegree, 0.8};
  out.mission = {{0.0, 17.0, 0.8, 80.0}};
  auto& imu = out.sensors.imu;
  imu.enabled = true;
  imu.rate_hz = 100.0;
  imu.gyro.bias_sigma = 1e-5;
  imu.gyro.vibration_sigma = 1.7e-4;
  imu.accelerometer.bias_sigma = 9.8e-3;
  imu.accelerometer.vibration_sigma = 9.8e-3;
  auto& depth = out.sensors.depth;
  depth.enabled = depth.wet_only = true;
  depth.rate_hz = 10.0;
  depth.phase_s = 0.02;
  depth.sigma_m = 0.05;
  depth.latency_s = 0.03;
  auto& propulsion = out.sensors.propulsion;
  propulsion.enabled = true;
  propulsion.rate_hz = 10.0;
  propulsion.phase_s = 0.07;
  propulsion.sigma_rpm = 15.0;
  propulsion.scale_sigma = 0.015;
  propulsion.latency_s = 0.02;
  return out;
}

EngineConfig engine_config() {
  EngineConfig config;
  config.alignment.mode = StartMode::air_drop;
  config.imu.accel_bias_sigma_m_s2 = 0.011;
  SensorConfig depth = default_sensor(SourceKind::depth, "depth");
  depth.sigma = {0.1, 0.1, 0.1};
  SensorConfig propulsion = default_sensor(SourceKind::propulsion, "propulsion");
  propulsion.scale_m_s_per_rpm = 0.0068;
  propulsion.min_depth_m = 10.0;
  propulsion.sigma = {0.3, 0.3, 0.3};
  config.sensors = {depth, propulsion};
  return config;
}

InitialState release() {
  InitialState state;
  state.latitude_rad = 0.6;
  state.longitude_rad = 2.0;
  state.altitude_m = 380.0;
  const Eigen::Vector3d v =
      geo::to_matrix(geo::from_rpy({6.0 * kDegree, -8.0 * kDegree, 0.8})) * Eigen::Vector3d(61.7, 0.0, 0.0);
  state.velocity_N_m_s = geo::arr(v);
  state.rpy_rad = {0.0, 0.0, 0.8};  // roll and pitch are not known
  state.position_sigma_N_m = {5.0, 5.0, 5.0};
  state.velocity_sigma_N_m_s = {1.0, 1.0, 1.0};
  state.attitude_sigma_rad = {10.0 * kDegree, 10.0 * kDegree, kDegree};
  return state;
}

struct Fall {
  explicit Fall(double until_s, std::uint64_t seed = 1) {
    sim::Simulation simulation(drop(), {kEpoch, seed, "auv"});
    while (simulation.time_s() < until_s - 1e-9) {
      simulation.advance(samples);
      truth.push_back(simulation.truth());
    }
    std::stable_sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) {
      return sim::header_of(a).received_ns < sim::header_of(b).received_ns;
    });
  }
  std::vector<sim::Measurement> samples;
  std::vector<Truth> truth;
};

void feed(FusionEngine& engine, const sim::Measurement& measurement) {
  std::visit([&engine](const auto& sample) { engine.add(sample); }, measurement);
}

TEST(DropEngine, GoesThroughThePhasesAndNavigatesOn) {
  const Fall fall(45.0);
  FusionEngine engine(engine_config());
  engine.start_from(release());
  std::vector<AlignmentPhase> phases;
  double aligned_s = 0.0;
  AlignmentStatus status;
  for (const auto& sample : fall.samples) {
    feed(engine, sample);
    const AlignmentPhase phase = engine.nav_state().alignment;
    if (phases.empty() || phases.back() != phase) phases.push_back(phase);
    const double t = to_seconds(engine.nav_state().header.stamp_ns - kEpoch);
    if (phase == AlignmentPhase::aligned && aligned_s == 0.0) aligned_s = t;
    if (aligned_s == 0.0 && t > 5.0 && t < 5.02) {
      engine.fill(status);
      EXPECT_EQ(status.phase, AlignmentPhase::waiting);
      EXPECT_EQ(status.condition_count, 10U);
      EXPECT_NE(std::string(status.advice.data()).find("water"), std::string::npos);
      EXPECT_GT(status.rpy_sigma_rad[0], 5.0 * kDegree);
    }
  }
  const std::vector<AlignmentPhase> wanted{AlignmentPhase::waiting, AlignmentPhase::averaging,
                                           AlignmentPhase::coarse, AlignmentPhase::fine,
                                           AlignmentPhase::aligned};
  EXPECT_EQ(phases, wanted);
  EXPECT_GT(aligned_s, 19.0);
  EXPECT_LT(aligned_s, 26.0);
  const NavState& nav = engine.nav_state();
  const Truth& truth = fall.truth.back();
  EXPECT_LT(std::abs(nav.rpy_rad[0] - truth.rpy_rad[0]), 0.4 * kDegree);
  EXPECT_LT(std::abs(nav.rpy_rad[1] - truth.rpy_rad[1]), 0.4 * kDegree);
  EXPECT_LT(std::abs(geo::wrap_pi(nav.rpy_rad[2] - truth.rpy_rad[2])), 2.0 * kDegree);
  const Eigen::Vector3d off = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                                {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
  const double sigma = std::sqrt(nav.position_covariance_N_m2[0] + nav.position_covariance_N_m2[4]);
  EXPECT_LT(off.head<2>().norm(), 60.0);
  EXPECT_LT(off.head<2>().norm(), 3.0 * sigma);
  EXPECT_NEAR(nav.depth_m, -truth.altitude_m, 1.0);
}

TEST(DropEngine, TheOrderOfArrivalDoesNotMatter) {
  const Fall fall(26.0);
  FusionEngine punctual(engine_config());
  FusionEngine late(engine_config());
  punctual.start_from(release());
  late.start_from(release());
  std::vector<sim::Measurement> held;
  for (const auto& sample : fall.samples) {
    feed(punctual, sample);
    const bool inertial = std::holds_alternative<ImuSample>(sample);
    if (!inertial) held.push_back(sample);
    if (inertial) feed(late, sample);
    if (held.size() >= 7) {
      for (const auto& one : held) feed(late, one);
      held.clear();
    }
  }
  for (const auto& one : held) feed(late, one);
  ImuSample last;
  for (const auto& sample : fall.samples)
    if (const auto* imu = std::get_if<ImuSample>(&sample)) last = *imu;
  last.header.stamp_ns += 10'000'000;
  punctual.add(last);
  late.add(last);
  EXPECT_EQ(punctual.nav_state().q_NB, late.nav_state().q_NB);
  EXPECT_EQ(punctual.nav_state().latitude_rad, late.nav_state().latitude_rad);
  EXPECT_EQ(punctual.nav_state().alignment, late.nav_state().alignment);
}

TEST(DropEngine, WithoutThePropulsorItNeverAlignsAndSaysWhy) {
  const Fall fall(40.0);
  FusionEngine engine(engine_config());
  engine.start_from(release());
  for (const auto& sample : fall.samples) {
    if (!std::holds_alternative<PropulsionSample>(sample)) feed(engine, sample);
    EXPECT_NE(engine.nav_state().alignment, AlignmentPhase::coarse);
    EXPECT_NE(engine.nav_state().alignment, AlignmentPhase::aligned);
  }
  AlignmentStatus status;
  engine.fill(status);
  EXPECT_EQ(status.phase, AlignmentPhase::timed_out);
  EXPECT_NE(std::string(status.advice.data()).find("propulsor"), std::string::npos);
}

TEST(DropEngine, AlignsAgainOnCommandUnderWay) {
  const Fall fall(60.0);
  FusionEngine engine(engine_config());
  engine.start_from(release());
  bool ordered = false;
  bool again = false;
  for (const auto& sample : fall.samples) {
    feed(engine, sample);
    const double t = to_seconds(engine.nav_state().header.stamp_ns - kEpoch);
    if (!ordered && t > 35.0) {
      ordered = true;
      EXPECT_EQ(engine.nav_state().alignment, AlignmentPhase::aligned);
      Command command;
      command.kind = CommandKind::realign;
      EXPECT_TRUE(engine.apply(command));
    }
    if (ordered && t > 35.1 && t < 35.2) again = engine.nav_state().alignment == AlignmentPhase::waiting;
  }
  EXPECT_TRUE(again);
  const NavState& nav = engine.nav_state();
  EXPECT_EQ(nav.alignment, AlignmentPhase::aligned);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LT(std::abs(nav.rpy_rad[i] - fall.truth.back().rpy_rad[i]), 0.4 * kDegree);
}

}  // namespace
}  // namespace fathom::estimation
