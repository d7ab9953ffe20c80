#include <cmath>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

constexpr double kSensitivity = 0.005 * kRadPerDeg / kStandardGravity_m_s2;  // rad/s per m/s^2
constexpr double kMemory_s = 30.0;
constexpr double kSampled_hz = 20.0;
constexpr double kRestLatitude_rad = 0.7;

/// Variance of the attitude error about down that a vehicle at rest collects, pitched up or down by turns of
/// `period_s`; the pitch jumps, and the gyros say so.
double heading_variance(double pitch_rad, double period_s, double duration_s, double sensitivity) {
  EngineConfig config;
  config.alignment.mode = StartMode::given;
  config.imu.nominal_rate_hz = kSampled_hz;
  config.imu.angle_random_walk_rad_sqrt_s = 1e-7;
  config.imu.gyro_bias_sigma_rad_s = config.imu.gyro_bias_instability_rad_s = 1e-11;
  config.imu.gyro_scale_sigma = config.imu.gyro_misalignment_sigma_rad = 0.0;
  config.imu.gyro_g_sensitivity_rad_s_per_m_s2 = sensitivity;
  FusionEngine engine(config);
  InitialState start;
  start.latitude_rad = kRestLatitude_rad;
  start.longitude_rad = start.altitude_m = 0.0;
  start.velocity_N_m_s = {0.0, 0.0, 0.0};
  start.rpy_rad = {0.0, pitch_rad, 0.0};
  start.position_sigma_N_m = {1.0, 1.0, 1.0};
  start.velocity_sigma_N_m_s = {0.1, 0.1, 0.1};
  start.attitude_sigma_rad = {1e-4, 1e-4, 1e-4};
  engine.start_from(start);
  double pitch = pitch_rad;
  for (int i = 0; i <= static_cast<int>(duration_s * kSampled_hz); ++i) {
    const double t = i / kSampled_hz;
    const double sign = static_cast<int>(t / period_s) % 2 == 0 ? 1.0 : -1.0;
    const double turned = sign * pitch_rad - pitch;
    pitch = sign * pitch_rad;
    const Eigen::Matrix3d c_BN = geo::to_matrix(geo::from_rpy({0.0, pitch, 0.0})).transpose();
    ImuSample sample;
    sample.header.stamp_ns = sample.header.received_ns = 1'700'000'000 * kNsPerSecond + from_seconds(t);
    sample.header.sequence = static_cast<std::uint64_t>(i);
    sample.angular_rate_B_rad_s =
        geo::arr(c_BN * geo::earth_rate_N(kRestLatitude_rad) + Vector3d(0.0, turned * kSampled_hz, 0.0));
    sample.specific_force_B_m_s2 = geo::arr(c_BN * Vector3d(0.0, 0.0, -geo::gravity(kRestLatitude_rad, 0.0)));
    engine.add(sample);
  }
  return engine.navigation_covariance()(8, 8);
}

double more_variance(double pitch_rad, double period_s, double duration_s) {
  return heading_variance(pitch_rad, period_s, duration_s, kSensitivity) -
         heading_variance(pitch_rad, period_s, duration_s, 0.0);
}

/// (NOISE-1) and (NOISE-4) after a step.
double expected(double pitch_rad, double t_s) {
  const double force2 = 2.0 * kStandardGravity_m_s2 * kStandardGravity_m_s2 * (1.0 - std::cos(pitch_rad));
  const double learned_s = kMemory_s * (1.0 - std::exp(-t_s / kMemory_s));
  return kSensitivity * kSensitivity * force2 * (learned_s * learned_s + 1.0 * t_s);
}

TEST(GSensitivity, AForceThatIsHeldTurnsTheAttitudeInProportionToTime) {
  for (const double t_s : {3.0, 10.0, 30.0, 120.0})
    EXPECT_NEAR(more_variance(20.0 * kRadPerDeg, 1e9, t_s) / expected(20.0 * kRadPerDeg, t_s), 1.0, 0.03)
        << t_s;
}

TEST(GSensitivity, WhatTheBiasHasLearnedAddsNoMore) {
  const double once = more_variance(20.0 * kRadPerDeg, 1e9, 120.0);
  const double longer = more_variance(20.0 * kRadPerDeg, 1e9, 240.0);
  const double white = expected(20.0 * kRadPerDeg, 240.0) - expected(20.0 * kRadPerDeg, 120.0);
  EXPECT_NEAR(longer - once, white, 0.05 * once);
}

TEST(GSensitivity, LevelAndAtRestItIsPartOfTheBias) {
  EXPECT_LT(more_variance(0.0, 1e9, 60.0), 1e-4 * expected(20.0 * kRadPerDeg, 60.0));
}

TEST(GSensitivity, PitchHeldUpAndDownByTurnsAddsUp) {
  // Each half period begins anew, the horizontal force with the other sign.
  const double twice = more_variance(20.0 * kRadPerDeg, 25.0, 50.0);
  const double eight_times = more_variance(20.0 * kRadPerDeg, 25.0, 200.0);
  EXPECT_GT(eight_times, 2.0 * twice);
  EXPECT_GT(twice, 10.0 * kSensitivity * kSensitivity * 3.4 * 3.4 * 50.0 / 2.0)
      << "more than white noise of 1 s";
}

}  // namespace
}  // namespace fathom::estimation
