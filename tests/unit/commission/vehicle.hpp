#pragma once

#include <cmath>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "base/units.hpp"
#include "commission/commission.hpp"
#include "dataset/dataset.hpp"
#include "geo/so3.hpp"
#include "sim/simulation.hpp"

namespace fathom::test {

/// An AUV that does what commissioning asks for: rest on deck, an octagon at the surface, dives with turns to
/// both sides at changing speed, and back.
inline sim::Scenario commissioning_vehicle() {
  sim::Scenario out;
  out.name = "commissioning";
  out.vehicle.kind = sim::VehicleConfig::Kind::auv;
  out.start.latitude_rad = 36.4 * kRadPerDeg;
  out.start.longitude_rad = 127.4 * kRadPerDeg;
  out.start.depth_m = 0.12;
  out.environment.surface_altitude_m = 18.5;
  out.environment.water_depth_m = 45.0;
  out.environment.turbulence_m_s = 0.01;
  out.environment.turbulence_tau_s = 2.0;
  double t = 0.0;
  double heading = 60.0;
  const auto step = [&](double lasts_s, double turn_deg, double speed_m_s, double depth_m) {
    heading = std::fmod(heading + turn_deg + 720.0, 360.0);
    sim::MissionStep one;
    one.at_s = t;
    one.speed_m_s = speed_m_s;
    one.heading_rad = heading * kRadPerDeg;
    one.depth_m = depth_m;
    out.mission.push_back(one);
    t += lasts_s;
  };
  step(130.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < 9; ++i) step(18.0, 50.0, 2.0, 0.0);
  for (int i = 0; i < 6; ++i) step(18.0, -70.0, 1.2 + 0.4 * (i % 3), 0.0);
  for (int i = 0; i < 24; ++i)
    step(25.0, i % 3 != 0 ? 100.0 : -120.0, 1.2 + 0.4 * (i % 3), 4.0 + 8.0 * (i % 2));
  step(40.0, 0.0, 2.0, 0.0);
  for (int i = 0; i < 6; ++i) step(15.0, 55.0, 2.0, 0.0);
  out.duration_s = t;
  auto& imu = out.sensors.of<ImuSample>();
  imu.enabled = true;
  imu.rate_hz = 100.0;
  imu.gyro.bias_sigma = 1.0 * kRadPerDeg / 3600.0;
  imu.gyro.random_walk = 0.1 * kRadPerDeg / 60.0;
  imu.gyro.scale_sigma = imu.accelerometer.scale_sigma = 2e-4;
  imu.gyro.misalignment_sigma_rad = imu.accelerometer.misalignment_sigma_rad = 3e-4;
  imu.accelerometer.bias_sigma = 0.0098;
  imu.accelerometer.random_walk = 0.03 / 60.0;
  auto& gps = out.sensors.of<GpsSample>();
  gps.enabled = true;
  gps.rate_hz = 2.0;
  gps.lever_B_m = {0.0, 0.0, -0.4};
  auto& dvl = out.sensors.of<DvlSample>();
  dvl.enabled = true;
  dvl.rate_hz = 5.0;
  dvl.lever_B_m = {0.5, 0.0, 0.2};
  auto& depth = out.sensors.of<DepthSample>();
  depth.enabled = true;
  depth.rate_hz = 10.0;
  auto& heading_sensor = out.sensors.of<HeadingSample>();
  heading_sensor.enabled = true;
  heading_sensor.rate_hz = 10.0;
  heading_sensor.sigma_rad = 0.3 * kRadPerDeg;
  return out;
}

inline dataset::Dataset drive(const sim::Scenario& scenario, std::uint64_t seed) {
  sim::Simulation::Options options;
  options.epoch_ns = dataset::kDefaultEpochNs;
  options.seed = seed;
  sim::Simulation simulation(scenario, options);
  dataset::Dataset data;
  std::vector<sim::Measurement> measurements;
  const double imu_hz = scenario.sensors.of<ImuSample>().rate_hz;
  const auto intervals = static_cast<int>(scenario.duration_s * imu_hz);
  for (int i = 0; i < intervals; ++i) {
    measurements.clear();
    simulation.advance(measurements);
    for (const auto& measurement : measurements)
      std::visit([&]<class T>(const T& sample) { data.of<T>().push_back(sample); }, measurement);
  }
  return data;
}

/// Of each inertial sample: rate and force through matrices.
inline void through(dataset::Dataset& data, const Eigen::Matrix3d& rate, const Eigen::Matrix3d& force) {
  for (ImuSample& sample : data.of<ImuSample>()) {
    sample.angular_rate_B_rad_s = geo::arr(rate * geo::vec(sample.angular_rate_B_rad_s));
    sample.specific_force_B_m_s2 = geo::arr(force * geo::vec(sample.specific_force_B_m_s2));
  }
}

inline void dvl_through(dataset::Dataset& data, const Eigen::Matrix3d& matrix) {
  for (DvlSample& sample : data.of<DvlSample>())
    sample.velocity_D_m_s = geo::arr(matrix * geo::vec(sample.velocity_D_m_s));
}

template <class Sample>
void stamp_late(dataset::Dataset& data, double by_s) {
  for (Sample& sample : data.of<Sample>()) {
    sample.header.stamp_ns += from_seconds(by_s);
    sample.header.received_ns += from_seconds(by_s);
  }
}

inline const commission::Finding* find(const commission::Findings& findings, const std::string& sensor,
                                       const std::string& what) {
  for (const auto& finding : findings)
    if (finding.sensor == sensor && finding.what == what) return &finding;
  return nullptr;
}

/// Every wrong finding as "sensor what: text", one a line.
inline std::string wrongs(const commission::Findings& findings) {
  std::string out;
  for (const auto& finding : findings)
    if (finding.severity == commission::Severity::wrong)
      out += finding.sensor + " " + finding.what + ": " + finding.text + "\n";
  return out;
}

}  // namespace fathom::test
