#include "drop_run.hpp"

#include <algorithm>
#include <variant>

#include "base/units.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::test {

sim::Scenario drop() {
  sim::Scenario out;
  out.vehicle.kind = sim::VehicleConfig::Kind::air_drop;
  out.environment.turbulence_m_s = 0.03;
  out.environment.water_depth_m = 500.0;
  out.start.latitude_rad = 0.6;
  out.start.longitude_rad = 2.0;
  out.start.depth_m = -380.0;
  out.start.speed_m_s = 61.7;
  out.start.rpy_rad = {6.0 * kRadPerDeg, -8.0 * kRadPerDeg, 0.8};
  out.mission = {{0.0, 17.0, 0.8, 80.0}};
  auto& imu = out.sensors.of<ImuSample>();
  imu.enabled = true;
  imu.rate_hz = 100.0;
  imu.gyro.bias_sigma = 1e-5;
  imu.gyro.vibration_sigma = 1.7e-4;
  imu.accelerometer.bias_sigma = 9.8e-3;
  imu.accelerometer.vibration_sigma = 9.8e-3;
  auto& depth = out.sensors.of<DepthSample>();
  depth.enabled = depth.wet_only = true;
  depth.rate_hz = 10.0;
  depth.phase_s = 0.02;
  depth.sigma_m = 0.05;
  depth.latency_s = 0.03;
  auto& propulsion = out.sensors.of<PropulsionSample>();
  propulsion.enabled = true;
  propulsion.rate_hz = 10.0;
  propulsion.phase_s = 0.07;
  propulsion.sigma_rpm = 15.0;
  propulsion.scale_sigma = 0.015;
  propulsion.latency_s = 0.02;
  return out;
}

EngineConfig drop_config() {
  EngineConfig config;
  config.alignment.mode = estimation::StartMode::air_drop;
  config.imu.accel_bias_sigma_m_s2 = 0.011;
  config.groups.log_scale = true;
  config.air_drop.slip_per_turn_m = 1.58;
  config.air_drop.trim_m2_s2 = 2.26;
  config.air_drop.flow_lag_m = 3.1;
  config.air_drop.surge_tau_s = 1.5;
  config.air_drop.speed_lag_s = 0.1;
  SensorConfig depth = estimation::default_sensor(SourceKind::depth, "depth");
  depth.sigma = {0.1, 0.1, 0.1};
  SensorConfig propulsion = estimation::default_sensor(SourceKind::propulsion, "propulsion");
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
  const Eigen::Vector3d v = geo::to_matrix(geo::from_rpy({6.0 * kRadPerDeg, -8.0 * kRadPerDeg, 0.8})) *
                            Eigen::Vector3d(61.7, 0.0, 0.0);
  state.velocity_N_m_s = geo::arr(v);
  state.rpy_rad = {0.0, 0.0, 0.8};  // roll and pitch are not known
  state.position_sigma_N_m = {5.0, 5.0, 5.0};
  state.velocity_sigma_N_m_s = {1.0, 1.0, 1.0};
  state.attitude_sigma_rad = {10.0 * kRadPerDeg, 10.0 * kRadPerDeg, kRadPerDeg};
  return state;
}

Fall::Fall(double until_s, std::uint64_t seed) {
  sim::Simulation simulation(drop(), {kEpoch, seed, "auv"});
  while (simulation.time_s() < until_s - 1e-9) {
    simulation.advance(samples);
    truth.push_back(simulation.truth());
  }
  std::stable_sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) {
    return header_of(a).received_ns < header_of(b).received_ns;
  });
}

void feed(FusionEngine& engine, const sim::Measurement& measurement) {
  std::visit([&engine](const auto& sample) { engine.add(sample); }, measurement);
}

}  // namespace fathom::test
