// The published estimator as a whole, on a vehicle whose instruments are perfect but for what a test adds.
#include "study/baselines/fixed_gain_navigator.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/vehicles/analytic_vehicle.hpp"

namespace fathom::study::fixed_gain {
namespace {

constexpr double kStep_s = 0.05;
constexpr double kLost_s = 120.0;
constexpr double kSpeed_m_s = 40.0;

struct Flight {
  OutageMode mode = OutageMode::mean;
  double turn_in_outage_rad = 0.0;
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();
  double fix_off_m = 0.0;  ///< of the last fix alone
};

double ramp(double t, double from, double length) {
  const double s = std::clamp((t - from) / length, 0.0, 1.0);
  return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
}

/// Horizontal error when GPS is lost and so many seconds later.
std::array<double, 2> errors_m(const Flight& flight, double outage_s) {
  test::AnalyticVehicle::Motion motion;
  motion.speed_m_s = [](double) { return kSpeed_m_s; };
  motion.rpy_rad = [&flight](double t) {
    return Eigen::Vector3d(0.0, 0.02, 0.4 + flight.turn_in_outage_rad * ramp(t, kLost_s, 4.0));
  };
  test::AnalyticVehicle vehicle(motion, {0.7, 0.3, 500.0}, kStep_s);
  InitialState start;
  start.latitude_rad = vehicle.position().latitude_rad;
  start.longitude_rad = vehicle.position().longitude_rad;
  start.altitude_m = vehicle.position().altitude_m;
  start.velocity_N_m_s = geo::arr(vehicle.v_N_m_s());
  start.rpy_rad = geo::arr(vehicle.rpy_rad());
  start.attitude_sigma_rad = {1e-3, 1e-3, 1e-3};
  Navigator::Config config;
  config.outage = flight.mode;
  Navigator navigator(config, start);
  std::array<double, 2> out{};
  const auto error = [&] {
    return (navigator.position_T_m() - navigator.frame().position_T_m(vehicle.position())).head<2>().norm();
  };
  const auto steps = static_cast<int>((kLost_s + outage_s) / kStep_s);
  for (int k = 0; k <= steps; ++k) {
    const TimeNs now = from_seconds(kStep_s * k);
    ImuSample imu;
    imu.header.stamp_ns = now;
    imu.angular_rate_B_rad_s = geo::arr(vehicle.rate_ib_B_rad_s());
    imu.specific_force_B_m_s2 = geo::arr(vehicle.force_B_m_s2() + flight.accel_bias_m_s2);
    if (k > 0 && k % 10 == 0 && kStep_s * k <= kLost_s) {
      GpsSample gps;
      gps.header.stamp_ns = now;
      gps.fix = GpsFix::fix_3d;
      const bool last = kStep_s * k > kLost_s - 0.4;
      const geo::Geodetic at = geo::moved_by(vehicle.position(), {last ? flight.fix_off_m : 0.0, 0.0, 0.0});
      gps.latitude_rad = at.latitude_rad;
      gps.longitude_rad = at.longitude_rad;
      gps.altitude_m = at.altitude_m;
      gps.velocity_N_m_s = geo::arr(vehicle.v_N_m_s());
      navigator.add(gps);
    }
    navigator.add(imu);
    if (kStep_s * k <= kLost_s) out[0] = error();
    Eigen::Vector3d unused_angle;
    Eigen::Vector3d unused_velocity;
    if (k < steps) vehicle.step(unused_angle, unused_velocity);
  }
  out[1] = error();
  return out;
}

TEST(FixedGainNavigator, FollowsPerfectInstrumentsWithAndWithoutGps) {
  for (const OutageMode mode : {OutageMode::mean, OutageMode::hold}) {
    const auto [aided, lost] = errors_m({.mode = mode, .turn_in_outage_rad = 1.0}, 20.0);
    EXPECT_LT(aided, 0.05);
    EXPECT_LT(lost, 1.0);
  }
}

TEST(FixedGainNavigator, TheMeanStandsForAnAccelerometerBiasUntilTheVehicleTurns) {
  const Flight straight{.accel_bias_m_s2 = {0.2, 0.0, 0.0}};
  EXPECT_LT(errors_m(straight, 10.0)[1], 3.0);  // alone it would be 10 m
  Flight turning = straight;
  turning.turn_in_outage_rad = M_PI;
  EXPECT_GT(errors_m(turning, 10.0)[1], 10.0);
}

TEST(FixedGainNavigator, WhatIsHeldIsTheWhimOfTheLastFix) {
  const double by_mean = errors_m({.mode = OutageMode::mean, .fix_off_m = 3.0}, 10.0)[1];
  const double by_hold = errors_m({.mode = OutageMode::hold, .fix_off_m = 3.0}, 10.0)[1];
  EXPECT_LT(by_mean, 5.0);
  EXPECT_GT(by_hold, 3.0 * by_mean);
}

}  // namespace
}  // namespace fathom::study::fixed_gain
