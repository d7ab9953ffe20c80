#include "study/hydro/experiment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/units.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::study::hydro {
namespace {

constexpr double kDepth_m = 20.0;

sim::Scenario scenario_of(const Case& one, std::uint64_t seed) {
  sim::Random random(seed, "hydro.case");
  sim::Scenario s;
  s.name = "hydro";
  s.duration_s = duration_s(one);
  const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
  s.environment.current_N_m_s = {one.current_m_s * std::cos(direction),
                                 one.current_m_s * std::sin(direction)};
  s.environment.water_depth_m = 60.0;
  s.environment.turbulence_m_s = 0.01;
  s.environment.turbulence_tau_s = 2.0;
  s.start.latitude_rad = 35.0 * kRadPerDeg;
  s.start.longitude_rad = 127.0 * kRadPerDeg;
  s.start.depth_m = kDepth_m;
  s.start.speed_m_s = kSpeed_m_s;
  s.start.rpy_rad = {-5.3 * kRadPerDeg, 0.0, 40.0 * kRadPerDeg};
  s.vehicle.kind = sim::VehicleConfig::Kind::remus;
  const auto order = [&](double at_s, double heading_deg, double depth_m) {
    sim::MissionStep step;
    step.at_s = at_s;
    step.speed_m_s = kSpeed_m_s;
    step.heading_rad = heading_deg * kRadPerDeg;
    step.depth_m = depth_m;
    s.mission.push_back(step);
  };
  order(0.0, 40.0, kDepth_m);
  if (one.straight) {
    order(100.0, 40.0, kDepth_m + 5.0);
  } else if (one.dvl_loss) {
    // A survey: lanes of a minute to and fro, joined by short legs across.
    double at_s = 0.0;
    for (int lane = 0; at_s < duration_s(one); ++lane) {
      order(at_s, lane % 2 == 0 ? 40.0 : 220.0, kDepth_m + lane % 3);
      order(at_s + 60.0, 130.0, kDepth_m + lane % 3);
      at_s += 75.0;
    }
  } else {
    order(50.0, 70.0, kDepth_m);
    order(100.0, 20.0, kDepth_m + 3.0);
    order(150.0, 50.0, kDepth_m);
  }

  auto& imu = s.sensors.of<ImuSample>();
  imu.enabled = true;
  imu.rate_hz = 100.0;
  imu.gyro.bias_sigma = 1.0 * kRadPerDeg / 3600.0;
  imu.gyro.random_walk = 0.05 * kRadPerDeg / 60.0;
  imu.accelerometer.bias_sigma = 0.5e-3 * 9.80665;
  imu.accelerometer.random_walk = 5e-4;
  auto& dvl = s.sensors.of<DvlSample>();
  dvl.enabled = true;
  dvl.rate_hz = kDvl_hz;
  dvl.phase_s = 0.05;
  dvl.beam_sigma_m_s = 0.707 * kDvlSigma_m_s;  // of a Janus head at 30 degrees
  dvl.beam_sigma_per_speed = 0.0;
  dvl.scale_sigma = kDvlScaleSigma;
  dvl.maximum_range_m = 200.0;
  if (one.dvl_loss) dvl.dropouts = {{kLossFrom_s, kLossFrom_s + kLoss_s + 1.0}};
  auto& depth = s.sensors.of<DepthSample>();
  depth.enabled = true;
  depth.rate_hz = 5.0;
  depth.phase_s = 0.02;
  depth.sigma_m = 0.02;
  auto& propulsion = s.sensors.of<PropulsionSample>();
  propulsion.enabled = true;
  propulsion.rate_hz = 5.0;
  propulsion.phase_s = 0.04;
  propulsion.sigma_rpm = 3.0;
  auto& fins = s.sensors.of<FinsSample>();
  fins.enabled = true;
  fins.rate_hz = 10.0;
  fins.phase_s = 0.03;
  fins.sigma_rad = 0.1 * kRadPerDeg;
  return s;
}

}  // namespace

double dvl_equivalent_sigma_m_s() {
  return std::hypot(kDvlSigma_m_s, kDvlScaleSigma * kSpeed_m_s * std::sqrt(kPublished_s * kDvl_hz));
}

double duration_s(const Case& one) {
  return one.dvl_loss ? kLossFrom_s + kLoss_s : kPublished_s;
}

Run make_run(const Case& one, std::uint64_t seed) {
  Run run;
  const sim::Scenario scenario = scenario_of(one, seed);
  sim::Simulation simulation(scenario, {kEpochNs, seed, "auv"});
  const Truth start = simulation.truth();
  run.truth.push_back(start);
  const int seconds = static_cast<int>(std::lround(scenario.duration_s));
  for (int t = 1; t <= seconds; ++t) {
    for (int i = 0; i < 100; ++i) simulation.advance(run.measurements);
    run.truth.push_back(simulation.truth());
  }
  std::stable_sort(run.measurements.begin(), run.measurements.end(), [](const auto& a, const auto& b) {
    return header_of(a).received_ns < header_of(b).received_ns;
  });

  sim::Random random(seed, "hydro.start");
  auto& given = run.start;
  given.stamp_ns = kEpochNs;
  given.position_sigma_N_m = {0.1, 0.1, 0.1};
  const double north_m = random.normal(given.position_sigma_N_m[0]);
  const double east_m = random.normal(given.position_sigma_N_m[1]);
  const double down_m = random.normal(given.position_sigma_N_m[2]);
  const geo::Geodetic place = geo::moved_by({start.latitude_rad, start.longitude_rad, start.altitude_m},
                                            Eigen::Vector3d(north_m, east_m, down_m));
  given.latitude_rad = place.latitude_rad;
  given.longitude_rad = place.longitude_rad;
  given.altitude_m = place.altitude_m;
  given.velocity_sigma_N_m_s = {0.05, 0.05, 0.05};
  for (std::size_t i = 0; i < 3; ++i)
    given.velocity_N_m_s[i] = start.velocity_N_m_s[i] + random.normal(given.velocity_sigma_N_m_s[i]);
  given.attitude_sigma_rad = {one.tilt_sigma_deg * kRadPerDeg, one.tilt_sigma_deg * kRadPerDeg,
                              kHeadingSigma_deg * kRadPerDeg};
  // The error about north, east and down: C_estimated = (I - [phi x]) C.
  const geo::Quaternion q = geo::from_rpy(geo::vec(start.rpy_rad));
  const Eigen::Vector3d phi(random.normal(given.attitude_sigma_rad[0]),
                            random.normal(given.attitude_sigma_rad[1]),
                            random.normal(given.attitude_sigma_rad[2]));
  given.rpy_rad = geo::arr(geo::to_rpy(geo::exp(-phi) * q));

  sim::Random coefficients(seed, "hydro.coefficients");
  run.coefficients =
      one.other_vehicle ? air_dropped() : perturbed(remus100(), one.coefficient_share, coefficients);
  return run;
}

}  // namespace fathom::study::hydro
