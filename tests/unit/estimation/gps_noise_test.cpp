// What of a fix's sigma is noise, and what the state of its slow error (AID-GPSP-3).
#include <cmath>

#include <gtest/gtest.h>

#include "estimation/aiding/gps_position.hpp"

namespace fathom::estimation {
namespace {

constexpr double kSlow_m = 1.5;

SensorConfig receiver() {
  SensorConfig sensor = default_sensor(SourceKind::gps, "gps");
  sensor.sigma = {0.4, 0.4, 0.8};
  return sensor;
}

GpsSample fix(GpsFix kind, double sigma_m) {
  GpsSample sample;
  sample.fix = kind;
  sample.position_sigma_N_m = {sigma_m, sigma_m, sigma_m};
  return sample;
}

TEST(GpsNoise, IsAllOfTheTotalWhereThereIsNoSlowState) {
  EXPECT_EQ(gps_noise(receiver(), fix(GpsFix::fix_3d, 2.5), 0, 0.0).sigma_m, 2.5);
}

TEST(GpsNoise, IsWhatTheSlowErrorLeavesOfTheTotal) {
  const GpsNoise noise = gps_noise(receiver(), fix(GpsFix::fix_3d, 2.5), 0, kSlow_m);
  EXPECT_EQ(noise.slow_share, 1.0);
  EXPECT_NEAR(noise.sigma_m, 2.0, 1e-12);
  EXPECT_EQ(noise.stated_m2, 2.5 * 2.5);
}

TEST(GpsNoise, TakesLessOfTheSlowStateWhereTheReceiverIsBetterThanThat) {
  const GpsNoise noise = gps_noise(receiver(), fix(GpsFix::differential, 0.9), 0, kSlow_m);
  EXPECT_NEAR(std::hypot(noise.sigma_m, noise.slow_share * kSlow_m), std::hypot(0.4, std::sqrt(0.9) * 0.9),
              1e-12);
  EXPECT_EQ(noise.sigma_m, 0.4) << "as configured, at least";
}

TEST(GpsNoise, KnowsWhatAnRtkFixIsWorth) {
  const GpsSample silent = fix(GpsFix::rtk_fixed, kUnknown);
  const GpsNoise noise = gps_noise(receiver(), silent, 0, kSlow_m);
  EXPECT_EQ(noise.sigma_m, 0.4);
  EXPECT_LT(noise.slow_share * kSlow_m, 0.03);
}

TEST(GpsNoise, IsAsConfiguredWhereTheSampleIsNotAsked) {
  SensorConfig sensor = receiver();
  sensor.use_sample_sigma = false;
  const GpsNoise noise = gps_noise(sensor, fix(GpsFix::fix_3d, 2.5), 0, kSlow_m);
  EXPECT_EQ(noise.sigma_m, 0.4);
  EXPECT_EQ(noise.slow_share, 1.0);
  EXPECT_EQ(noise.stated_m2, 0.0);
}

}  // namespace
}  // namespace fathom::estimation
