#include <cmath>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "sim/random.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

constexpr double kDegPerHour = kRadPerDeg / 3600.0;
constexpr double kImu_hz = 10.0;

struct Gyro {
  double bias_rad_s;
  double random_walk_rad_sqrt_s;
};

struct Found {
  bool aligned = false;
  double error_rad = 0.0;
  double sigma_rad = 0.0;
};

/// A vehicle that lies still for `seconds` at an unknown heading, with a position and no compass.
Found lie_still(const Gyro& gyro, double latitude_rad, double window_s, double seconds, std::uint64_t seed) {
  sim::Random random(seed, "rest");
  EngineConfig config;
  config.alignment.mode = StartMode::at_rest;
  config.alignment.heading_source = HeadingSource::gyrocompass;
  config.alignment.averaging_s = window_s;
  config.alignment.position_given = true;
  config.alignment.given_latitude_rad = latitude_rad;
  config.imu.nominal_rate_hz = kImu_hz;
  config.imu.gyro_bias_sigma_rad_s = gyro.bias_rad_s;
  config.imu.gyro_bias_instability_rad_s = 0.1 * gyro.bias_rad_s;
  config.imu.angle_random_walk_rad_sqrt_s = gyro.random_walk_rad_sqrt_s;
  config.imu.accel_bias_sigma_m_s2 = 1e-3;
  FusionEngine engine(config);

  const Vector3d rpy(random.normal(0.03), random.normal(0.03), random.uniform(-3.1, 3.1));
  const Eigen::Matrix3d c_BN = geo::to_matrix(geo::from_rpy(rpy)).transpose();
  const auto normal = [&random](double sigma) {
    return Vector3d(random.normal(sigma), random.normal(sigma), random.normal(sigma));
  };
  const Vector3d rate = c_BN * geo::earth_rate_N(latitude_rad) + normal(gyro.bias_rad_s);
  const Vector3d force = c_BN * Vector3d(0.0, 0.0, -geo::gravity(latitude_rad, 0.0)) + normal(1e-3);
  Found out;
  ImuSample sample;
  for (int i = 0; i <= static_cast<int>(seconds * kImu_hz); ++i) {
    sample.header.stamp_ns = 1'700'000'000 * kNsPerSecond + from_seconds(i / kImu_hz);
    sample.header.received_ns = sample.header.stamp_ns;
    sample.header.sequence = static_cast<std::uint64_t>(i);
    sample.angular_rate_B_rad_s = geo::arr(rate + normal(gyro.random_walk_rad_sqrt_s * std::sqrt(kImu_hz)));
    sample.specific_force_B_m_s2 = geo::arr(force + normal(1e-3));
    engine.add(sample);
  }
  const NavState& nav = engine.nav_state();
  if (!known(nav.rpy_rad[2])) return out;
  out.aligned = true;
  out.error_rad = geo::wrap_pi(nav.rpy_rad[2] - rpy.z());
  out.sigma_rad = nav.rpy_sigma_rad[2];
  return out;
}

TEST(Gyrocompass, ANavigationGradeGyroFindsNorthInFiveMinutes) {
  // 0.01 deg/h and 0.002 deg/sqrt(h).
  const Gyro gyro{0.01 * kDegPerHour, 0.002 * kRadPerDeg / 60.0};
  for (const double latitude_deg : {0.0, 45.0, 65.0}) {
    double square = 0.0;
    constexpr int kRuns = 12;
    for (int run = 0; run < kRuns; ++run) {
      const Found found =
          lie_still(gyro, latitude_deg * kRadPerDeg, 280.0, 300.0, static_cast<std::uint64_t>(run + 1));
      ASSERT_TRUE(found.aligned) << latitude_deg;
      square += found.error_rad * found.error_rad;
    }
    EXPECT_LT(std::sqrt(square / kRuns), 0.1 * kRadPerDeg / std::cos(latitude_deg * kRadPerDeg))
        << latitude_deg;
  }
}

TEST(Gyrocompass, TheSigmaOfATacticalGyroIsTrue) {
  // 0.25 deg/h left of the bias and 0.125 deg/sqrt(h), ten minutes, 20 degrees north: about 1.6 degrees.
  const Gyro gyro{0.25 * kDegPerHour, 0.125 * kRadPerDeg / 60.0};
  constexpr int kRuns = 100;
  double normalised = 0.0;
  double sigma = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Found found = lie_still(gyro, 20.0 * kRadPerDeg, 595.0, 600.0, static_cast<std::uint64_t>(run + 1));
    ASSERT_TRUE(found.aligned) << run;
    normalised += std::pow(found.error_rad / found.sigma_rad, 2);
    sigma += found.sigma_rad / kRuns;
  }
  EXPECT_NEAR(sigma, 1.6 * kRadPerDeg, 0.4 * kRadPerDeg);
  // Chi-square with 100 degrees of freedom, 99 %: 0.67 to 1.40; the sigma may be a little wide.
  EXPECT_GT(normalised / kRuns, 0.55);
  EXPECT_LT(normalised / kRuns, 1.40);
}

}  // namespace
}  // namespace fathom::estimation
