#include <cmath>

#include <gtest/gtest.h>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "sim/scenario.hpp"
#include "sim/truth_generator.hpp"
#include "sim/vehicles/vehicle.hpp"
#include "vehicles.hpp"

namespace fathom::sim {
namespace {

TruthPoint level_point(double t_s = 0.0) {
  TruthPoint out;
  out.t_s = t_s;
  out.latitude_rad = 0.7;
  out.longitude_rad = 0.1;
  out.altitude_m = 10.0;
  out.depth_m = 10.0;
  out.water_depth_m = 50.0;
  out.q_NB = q_of_rpy(0.0, 0.0, 1.0);
  out.v_N_m_s = out.q_NB * Eigen::Vector3d(2.0, 0.3, -0.1);
  out.V_B_m_s = {2.0, 0.3, -0.1};
  return out;
}

TEST(TriadModel, BiasScaleAndNoiseHaveTheirSizes) {
  TriadConfig config;
  config.bias_sigma = 0.01;
  config.scale_sigma = 0.001;
  config.random_walk = 0.002;
  double bias_square = 0.0;
  double scale_square = 0.0;
  double noise_square = 0.0;
  const int runs = 300;
  const int samples = 100;
  const double dt = 0.01;
  for (int run = 0; run < runs; ++run) {
    Random random(static_cast<std::uint64_t>(run), "triad");
    TriadModel model(config, random);
    bias_square += model.bias().squaredNorm() / 3.0 / runs;
    TriadConfig quiet = config;
    quiet.random_walk = 0.0;
    Random same(static_cast<std::uint64_t>(run), "triad");
    TriadModel clean(quiet, same);
    const Eigen::Vector3d exact =
        clean.increment(Eigen::Vector3d(0.1, 0.2, 0.3), dt, same) - clean.bias() * dt;
    const double scale = exact.x() / 0.1 - 1.0;
    scale_square += scale * scale / runs;
    for (int i = 0; i < samples; ++i) {
      const Eigen::Vector3d error = model.increment(Eigen::Vector3d::Zero(), dt, random) - model.bias() * dt;
      noise_square += error.squaredNorm() / 3.0 / samples / runs;
    }
  }
  EXPECT_NEAR(std::sqrt(bias_square), 0.01, 0.001);
  EXPECT_NEAR(std::sqrt(scale_square), 0.001, 0.00015);
  EXPECT_NEAR(std::sqrt(noise_square), 0.002 * std::sqrt(dt), 0.002 * std::sqrt(dt) * 0.05);
}

TEST(TriadModel, QuantisationLosesNothingInTheLongRun) {
  TriadConfig config;
  config.quantum = 1e-4;
  Random random(1, "quantum");
  TriadModel model(config, random);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d out = model.increment(Eigen::Vector3d(1.23e-5, -3.7e-5, 0.0), 0.01, random);
    EXPECT_NEAR(std::remainder(out.x(), 1e-4), 0.0, 1e-12);
    sum += out;
  }
  EXPECT_NEAR(sum.x(), 1.23e-2, 1e-4);
  EXPECT_NEAR(sum.y(), -3.7e-2, 1e-4);
}

TEST(TriadModel, ClipsAtItsRange) {
  TriadConfig config;
  config.range = 2.0;
  Random random(1, "range");
  TriadModel model(config, random);
  EXPECT_EQ(model.point(Eigen::Vector3d(5.0, -5.0, 1.0), 0.01, random), Eigen::Vector3d(2.0, -2.0, 1.0));
  EXPECT_NEAR(model.increment(Eigen::Vector3d(0.05, 0.0, 0.0), 0.01, random).x(), 0.02, 1e-12);
}

TEST(ImuModel, IncrementsAndRatesAgree) {
  ImuConfig config;
  config.gyro.bias_sigma = 1e-3;
  config.accelerometer.random_walk = 1e-3;
  ImuModel model(config, 1);
  const ImuTruth truth{0.01, {1e-3, 2e-3, 3e-3}, {0.01, 0.02, -0.098}};
  const ImuSample sample = model.sample(truth, level_point());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(sample.angular_rate_B_rad_s[i] * 0.01, sample.delta_angle_B_rad[i], 1e-15);
    EXPECT_NEAR(sample.specific_force_B_m_s2[i] * 0.01, sample.delta_velocity_B_m_s[i], 1e-15);
  }
  EXPECT_EQ(sample.delta_time_s, 0.01);
}

TEST(GpsModel, NoFixUnderWaterAndAfterSurfacingUntilAcquired) {
  GpsConfig config;
  config.lever_B_m = {0.0, 0.0, -0.4};
  config.reacquire_s = 2.5;
  GpsModel gps(config, {}, 1);
  TruthPoint at = level_point(0.0);
  at.depth_m = 0.1;  // antenna 0.3 m above the water
  gps.observe(at);
  EXPECT_TRUE(gps.available());
  at.t_s = 1.0;
  at.depth_m = 0.39;  // antenna 1 cm above it: washed over
  gps.observe(at);
  EXPECT_FALSE(gps.available());
  const GpsSample none = gps.sample(at);
  EXPECT_EQ(none.fix, GpsFix::none);
  EXPECT_FALSE(known(none.latitude_rad));
  at.depth_m = 0.1;
  for (const double t_s : {1.1, 2.0, 3.4}) {
    at.t_s = t_s;
    gps.observe(at);
    EXPECT_FALSE(gps.available()) << t_s;
  }
  at.t_s = 3.6;
  gps.observe(at);
  EXPECT_TRUE(gps.available());
  EXPECT_EQ(gps.sample(at).fix, GpsFix::fix_3d);
}

TEST(GpsModel, ErrorHasItsSizeAndIsThatOfTheAntenna) {
  GpsConfig config;
  config.lever_B_m = {3.0, 0.0, -0.4};
  config.position_sigma_m = 0.5;
  config.correlated_sigma_m = 1.2;
  config.correlated_tau_s = 60.0;
  double square = 0.0;
  double mean = 0.0;
  const int runs = 400;
  for (int run = 0; run < runs; ++run) {
    GpsModel gps(config, {}, static_cast<std::uint64_t>(run));
    TruthPoint at = level_point(100.0);
    at.depth_m = 0.0;
    const GpsSample sample = gps.sample(at);
    const TruthPoint antenna = at_lever(at, {3.0, 0.0, -0.4});
    const double north = geo::difference_N({antenna.latitude_rad, antenna.longitude_rad, antenna.altitude_m},
                                           {sample.latitude_rad, sample.longitude_rad, sample.altitude_m})
                             .x();
    mean += north / runs;
    square += north * north / runs;
  }
  EXPECT_NEAR(mean, 0.0, 0.2);
  EXPECT_NEAR(std::sqrt(square), 1.3, 0.13);
}

TEST(DvlModel, PerfectInstrumentMeasuresTheVelocityAtItsPlaceInItsAxes) {
  DvlConfig config;
  config.beam_sigma_m_s = 0.0;
  config.beam_sigma_per_speed = 0.0;
  config.lever_B_m = {1.0, 0.0, 0.0};
  config.mounting_rpy_rad = {0.0, 0.0, 0.5};
  DvlModel dvl(config, 1);
  TruthPoint at = level_point();
  at.omega_NB_B_rad_s = {0.0, 0.0, 0.2};
  const DvlSample sample = dvl.sample(at);
  const Eigen::Vector3d expected =
      q_of_rpy(0.0, 0.0, 0.5).conjugate() * Eigen::Vector3d(2.0, 0.3 + 0.2 * 1.0, -0.1);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(sample.velocity_D_m_s[i], expected[static_cast<int>(i)], 1e-12);
  }
  EXPECT_NEAR(sample.altitude_m, 40.0, 1e-9);
  EXPECT_NEAR(sample.error_velocity_m_s, 0.0, 1e-12);
  // Beam 3 looks ahead and down.
  EXPECT_NEAR(sample.beam_velocity_m_s[2],
              expected.x() * 0.5 + expected.z() * std::cos(config.beam_angle_rad), 1e-12);
}

TEST(DvlModel, ThreeBeamsStillGiveTheVelocityTwoDoNot) {
  DvlConfig config;
  config.beam_sigma_m_s = 0.0;
  config.beam_sigma_per_speed = 0.0;
  config.beam_dropout_probability = 0.4;
  DvlModel dvl(config, 1);
  int three = 0;
  int fewer = 0;
  for (int i = 0; i < 500; ++i) {
    const DvlSample sample = dvl.sample(level_point());
    int good = 0;
    for (const double beam : sample.beam_velocity_m_s) good += known(beam) ? 1 : 0;
    if (good < 3) {
      ++fewer;
      EXPECT_FALSE(known(sample.velocity_D_m_s[0]));
    } else {
      EXPECT_NEAR(sample.velocity_D_m_s[0], 2.0, 1e-9);
      EXPECT_EQ(known(sample.error_velocity_m_s), good == 4);
      three += good == 3 ? 1 : 0;
    }
  }
  EXPECT_GT(three, 100);
  EXPECT_GT(fewer, 100);
}

TEST(DvlModel, LosesTheBottomBeyondItsRangeAndInDropouts) {
  DvlConfig config;
  config.maximum_range_m = 30.0;
  config.dropouts = {{10.0, 20.0}};
  DvlModel dvl(config, 1);
  TruthPoint at = level_point();
  EXPECT_FALSE(known(dvl.sample(at).velocity_D_m_s[0]));  // 40 m above the bottom
  at.depth_m = 35.0;
  EXPECT_TRUE(known(dvl.sample(at).velocity_D_m_s[0]));
  at.t_s = 15.0;
  EXPECT_FALSE(known(dvl.sample(at).velocity_D_m_s[0]));
}

TEST(HeadingModel, DeviationAndVariation) {
  HeadingConfig config;
  config.deviation_rad = {0.01, 0.02, 0.03, 0.04, 0.05};
  config.magnetic = true;
  EnvironmentConfig environment;
  environment.magnetic_variation_rad = -0.1;
  HeadingModel compass(config, environment, 1);
  const HeadingSample sample = compass.sample(level_point());
  const double psi = 1.0;
  const double expected = psi + 0.01 + 0.02 * std::sin(psi) + 0.03 * std::cos(psi) +
                          0.04 * std::sin(2 * psi) + 0.05 * std::cos(2 * psi) + 0.1;
  EXPECT_NEAR(sample.heading_rad, expected, 1e-12);
  EXPECT_EQ(sample.north, North::magnetic);
}

TEST(UsblModel, ErrorGrowsWithRangeAndShallowTransponderIsSilent) {
  UsblConfig config;
  config.range_fraction = 0.01;
  config.floor_m = 0.1;
  config.ship_N_m = {1000.0, 0.0, 0.0};
  config.minimum_depth_m = 2.0;
  Scenario scenario = test::auv_scenario();
  scenario.start.latitude_rad = 0.7;
  scenario.start.longitude_rad = 0.1;
  UsblModel usbl(config, scenario, 1);
  double square = 0.0;
  const int n = 1000;
  for (int i = 0; i < n; ++i) {
    const auto sample = usbl.sample(level_point());
    ASSERT_TRUE(sample.has_value());
    const auto off = geo::difference_N({0.7, 0.1, 10.0}, {sample->latitude_rad, sample->longitude_rad, 10.0});
    square += off.x() * off.x() / n;
    const double latency_s = usbl.latency_s();
    EXPECT_GE(latency_s, config.latency_s);
    EXPECT_LE(latency_s, config.maximum_latency_s);
  }
  EXPECT_NEAR(std::sqrt(square), 10.0, 1.0);
  TruthPoint shallow = level_point();
  shallow.depth_m = 1.0;
  EXPECT_FALSE(usbl.sample(shallow).has_value());
}

TEST(UsblModel, WhatItSendsOfAMovingShipPutsTheTransponderWhereItIs) {
  UsblConfig config;
  config.range_fraction = config.floor_m = config.angle_sigma_rad = 0.0;
  config.ship_N_m = {100.0, -40.0, 5.0};
  config.ship_velocity_N_m_s = {2.0, 1.0, 0.0};
  config.ship_rpy_rad = {0.1, -0.05, 1.2};
  config.lever_B_m = {0.5, 0.0, -0.3};
  Scenario scenario = test::auv_scenario();
  scenario.start.latitude_rad = 0.7;
  scenario.start.longitude_rad = 0.1;
  TruthPoint at = level_point();
  at.t_s = 30.0;
  const UsblSample place = UsblModel(config, scenario, 1).sample(at).value();
  const geo::Geodetic transponder{place.latitude_rad, place.longitude_rad, -place.depth_m};
  using Output = UsblConfig::Output;
  for (const Output output : {Output::ned, Output::vessel, Output::range_bearing, Output::inverted}) {
    config.output = output;
    const UsblSample s = UsblModel(config, scenario, 1).sample(at).value();
    Eigen::Vector3d path = geo::vec(s.relative_m);
    if (known(s.range_m)) {
      path = s.range_m * Eigen::Vector3d(std::cos(s.depression_rad) * std::cos(s.bearing_rad),
                                         std::cos(s.depression_rad) * std::sin(s.bearing_rad),
                                         std::sin(s.depression_rad));
    }
    if (s.frame == UsblFrame::vessel_frd)
      path = geo::to_matrix(geo::from_rpy(geo::vec(s.station_rpy_rad))) * path;
    if (s.frame == UsblFrame::vehicle_frd) path = -(at.q_NB * path);
    const geo::Geodetic ship{s.station_latitude_rad, s.station_longitude_rad, -s.station_depth_m};
    EXPECT_LT((geo::difference_N(ship, transponder) - path).norm(), 1e-3) << static_cast<int>(output);
    EXPECT_NEAR(s.station_latitude_rad, geo::moved_by({0.7, 0.1, 0.0}, {160.0, -10.0, 5.0}).latitude_rad,
                1e-10);
  }
}

TEST(DepthModel, ReadsZeroInTheAir) {
  DepthConfig config;
  config.sigma_m = 0.0;
  DepthModel depth(config, 1);
  TruthPoint at = level_point();
  at.depth_m = -100.0;
  EXPECT_EQ(depth.sample(at).value().depth_m, 0.0);
  DepthConfig switched = config;
  switched.wet_only = true;
  EXPECT_FALSE(DepthModel(switched, 1).sample(at).has_value());
  at.depth_m = 12.5;
  EXPECT_EQ(depth.sample(at).value().depth_m, 12.5);
  EXPECT_TRUE(DepthModel(switched, 1).sample(at).has_value());
}

TEST(AirspeedModel, IndicatesLessInThinAndWarmAirAndKnowsTheTrueSpeed) {
  AirspeedConfig config;
  config.sigma_m_s = config.baro_sigma_m = config.baro_bias_sigma_m = 0.0;
  EnvironmentConfig environment;
  TruthPoint point;
  point.altitude_m = 3000.0;
  point.V_B_m_s = {60.0, 0.0, 2.0};
  const AirspeedSample standard = AirspeedModel(config, environment, 1).sample(point);
  // Density at 3000 m over that at sea level, U.S. Standard Atmosphere 1976; compression adds 0.1 m/s.
  EXPECT_NEAR(standard.airspeed_m_s, std::sqrt(0.74225) * 60.0, 0.15);
  EXPECT_NEAR(standard.true_airspeed_m_s, 60.0, 1e-9);
  environment.air_temperature_offset_K = 20.0;
  const AirspeedSample warm = AirspeedModel(config, environment, 1).sample(point);
  EXPECT_NEAR(warm.airspeed_m_s, std::sqrt(0.74225 * 268.65 / 288.65) * 60.0, 0.15);
  EXPECT_NEAR(warm.true_airspeed_m_s, 60.0, 1e-9);
}

}  // namespace
}  // namespace fathom::sim
