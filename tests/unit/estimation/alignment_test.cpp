#include <cmath>

#include <gtest/gtest.h>

#include "estimation/alignment/rest_window.hpp"
#include "estimation/engine/forecaster.hpp"
#include "support/orders.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

/// Feeds the survey until an instant; then gives the engine's state.
void feed_until(FusionEngine& engine, const SurveyRun& run, double until_s, bool compass = true,
                bool gps = true) {
  for (const test::Sample& sample : run.samples) {
    if (to_seconds(test::header(sample).received_ns - SurveyRun::kEpochNs) > until_s) return;
    if (!compass && std::holds_alternative<HeadingSample>(sample)) continue;
    if (!gps && std::holds_alternative<GpsSample>(sample)) continue;
    test::feed(engine, sample);
  }
}

TEST(Alignment, GoesThroughItsPhasesAndSaysWhatItWaitsFor) {
  const SurveyRun run({.duration_s = 19.0});
  FusionEngine engine(SurveyRun::config());
  AlignmentStatus status;
  engine.fill(status);
  EXPECT_EQ(status.phase, AlignmentPhase::none);
  feed_until(engine, run, 4.0);
  engine.fill(status);
  EXPECT_EQ(status.phase, AlignmentPhase::averaging);
  EXPECT_EQ(engine.nav_state().mode, NavMode::none);
  EXPECT_FALSE(known(engine.nav_state().latitude_rad));
  EXPECT_NEAR(status.time_to_aligned_s, 5.0, 0.1);
  ASSERT_GE(status.condition_count, 5U);
  EXPECT_GT(status.conditions[0].value, 0.0);
  EXPECT_TRUE(status.conditions[0].met);

  FusionEngine whole(SurveyRun::config());
  feed_until(whole, run, 18.0);
  whole.fill(status);
  EXPECT_EQ(status.phase, AlignmentPhase::aligned);
  EXPECT_EQ(status.time_to_aligned_s, 0.0);
  EXPECT_LT(status.rpy_sigma_rad[2], 0.044);
  const NavState& nav = whole.nav_state();
  const Truth& truth = run.truth[1800];
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(std::abs(nav.rpy_rad[i] - truth.rpy_rad[i]), 0.005);
  EXPECT_LT(std::abs(geo::wrap_pi(nav.rpy_rad[2] - truth.rpy_rad[2])), 0.05);
}

TEST(Alignment, WithoutHeadingItLevelsAndAsksForOne) {
  const SurveyRun run({.duration_s = 19.0, .wave_rad = 0.02});
  EngineConfig config = SurveyRun::config();
  config.alignment.heading_source = HeadingSource::compass;
  FusionEngine engine(config);
  feed_until(engine, run, 12.0, false);
  AlignmentStatus status;
  engine.fill(status);
  EXPECT_EQ(status.phase, AlignmentPhase::coarse);
  EXPECT_NE(std::string(status.advice.data()).find("heading"), std::string::npos);
  const NavState& nav = engine.nav_state();
  EXPECT_EQ(nav.mode, NavMode::aligning);
  EXPECT_TRUE(known(nav.rpy_rad[0]));
  EXPECT_FALSE(known(nav.rpy_rad[2]));
  EXPECT_FALSE(known(nav.latitude_rad));
}

/// The survey with a heading from two antennas beside the compass, 3 degrees apart from it.
SurveyRun with_two_antennas(const SurveyRun::Options& options, double sigma_rad) {
  SurveyRun run(options);
  test::Normal normal(11);
  std::vector<test::Sample> both;
  for (const test::Sample& sample : run.samples) {
    both.push_back(sample);
    const auto* compass = std::get_if<HeadingSample>(&sample);
    if (compass == nullptr) continue;
    const auto k = (compass->header.stamp_ns - SurveyRun::kEpochNs) / 10'000'000;
    HeadingSample antennas = *compass;
    antennas.header.sensor = "gps_heading0";
    antennas.heading_rad =
        geo::wrap_two_pi(run.truth[static_cast<std::size_t>(k)].rpy_rad[2] + 0.3 + normal(sigma_rad));
    antennas.sigma_rad = sigma_rad;
    both.emplace_back(antennas);
    auto& spoiled = std::get<HeadingSample>(both[both.size() - 2]);
    spoiled.heading_rad = geo::wrap_two_pi(spoiled.heading_rad + 0.05);
  }
  run.samples = std::move(both);
  return run;
}

EngineConfig two_antenna_config(HeadingSource source) {
  EngineConfig config = SurveyRun::config();
  auto antennas = default_sensor(SourceKind::heading, "gps_heading0");
  antennas.two_antenna = true;
  antennas.sigma = {0.002, 0.002, 0.002};
  antennas.mounting_rpy_rad = {0.0, 0.0, 0.3};  // the front antenna is to starboard of the rear one
  config.sensors.push_back(antennas);
  config.alignment.heading_source = source;
  return config;
}

TEST(Alignment, TwoAntennasStartItAtRestAsWellAsTheySay) {
  const SurveyRun run = with_two_antennas({.duration_s = 19.0}, 0.004);
  for (const HeadingSource source : {HeadingSource::automatic, HeadingSource::two_antenna}) {
    FusionEngine engine(two_antenna_config(source));
    AlignmentStatus status;
    for (const test::Sample& sample : run.samples) {
      test::feed(engine, sample);
      engine.fill(status);
      if (status.phase >= AlignmentPhase::fine) break;
    }
    ASSERT_GE(status.phase, AlignmentPhase::fine);
    const NavState& nav = engine.nav_state();
    const auto k = static_cast<std::size_t>((nav.header.stamp_ns - SurveyRun::kEpochNs) / 10'000'000);
    // The compass is 0.05 rad and more out, and would have been taken for 0.026.
    EXPECT_LT(std::abs(geo::wrap_pi(nav.rpy_rad[2] - run.truth[k].rpy_rad[2])), 0.006);
    EXPECT_NEAR(status.rpy_sigma_rad[2], 0.004, 0.001);
  }
}

// What of it stays is half of the sigma: the headings that follow have the same error (ALN-23).
TEST(Alignment, TwoAntennasConfirmNothingOfTheirOwnStart) {
  constexpr double kSigma_rad = 0.004;
  const SurveyRun run = with_two_antennas({.duration_s = 19.0}, kSigma_rad);
  EngineConfig config = two_antenna_config(HeadingSource::two_antenna);
  config.sensors.back().sigma.fill(kSigma_rad);
  std::erase_if(config.sensors, [](const SensorConfig& one) { return one.sensor == "compass0"; });
  FusionEngine engine(config);
  feed_until(engine, run, 18.0);
  AlignmentStatus status;
  engine.fill(status);
  ASSERT_GE(status.phase, AlignmentPhase::fine);
  EXPECT_GT(status.rpy_sigma_rad[2], 0.5 * kSigma_rad);
  EXPECT_LT(status.rpy_sigma_rad[2], 0.65 * kSigma_rad);
}

TEST(Alignment, ACompassIsNotTakenForTwoAntennas) {
  const SurveyRun run = with_two_antennas({.duration_s = 19.0}, 0.004);
  EngineConfig config = two_antenna_config(HeadingSource::two_antenna);
  config.sensors.pop_back();
  FusionEngine engine(config);
  feed_until(engine, run, 18.0);
  EXPECT_EQ(engine.nav_state().mode, NavMode::aligning);
  // And the other way round.
  FusionEngine compass(two_antenna_config(HeadingSource::compass));
  feed_until(compass, run, 18.0);
  AlignmentStatus status;
  compass.fill(status);
  EXPECT_GE(status.phase, AlignmentPhase::fine);
}

TEST(Alignment, WithoutPositionItAsksForOneAndTakesAnOrder) {
  const SurveyRun run({.duration_s = 19.0});
  FusionEngine engine(SurveyRun::config());
  feed_until(engine, run, 12.0, true, false);
  AlignmentStatus status;
  engine.fill(status);
  EXPECT_EQ(status.phase, AlignmentPhase::coarse);
  EXPECT_NE(std::string(status.advice.data()).find("position"), std::string::npos);
  Command command;
  command.kind = CommandKind::set_position;
  command.latitude_rad = run.truth[0].latitude_rad;
  command.longitude_rad = run.truth[0].longitude_rad;
  command.sigma_m = 4.0;
  EXPECT_EQ(test::order_now(engine, command), "");
  ImuSample next;
  for (const test::Sample& sample : run.samples)
    if (const auto* imu = std::get_if<ImuSample>(&sample);
        imu != nullptr && imu->header.stamp_ns > engine.nav_state().header.stamp_ns) {
      next = *imu;
      break;
    }
  ASSERT_TRUE(engine.add(next));
  engine.fill(status);
  EXPECT_EQ(status.phase, AlignmentPhase::fine);
  EXPECT_NEAR(engine.nav_state().latitude_rad, command.latitude_rad, 1e-9);
}

TEST(Alignment, DoesNotStartOnAVehicleThatIsShaken) {
  const SurveyRun run({.duration_s = 15.0, .wave_rad = 0.35});
  FusionEngine engine(SurveyRun::config());
  feed_until(engine, run, 14.0);
  AlignmentStatus status;
  engine.fill(status);
  EXPECT_LT(status.phase, AlignmentPhase::coarse);
  EXPECT_EQ(engine.nav_state().mode, NavMode::none);
}

TEST(Alignment, StartsInMotionFromGpsVelocity) {
  // Straight and level at 30 m/s; nothing but GPS.
  test::Normal normal(3);
  test::AnalyticVehicle::Motion motion;
  motion.speed_m_s = [](double) { return 30.0; };
  motion.rpy_rad = [](double t) {
    const double bank = t > 15.0 ? 0.4 * std::sin(0.3 * (t - 15.0)) : 0.0;
    return Eigen::Vector3d(bank, 0.02, 0.7 + (t > 15.0 ? 0.3 * (1.0 - std::cos(0.3 * (t - 15.0))) : 0.0));
  };
  test::AnalyticVehicle vehicle(motion, {0.6, 2.0, 500.0}, 0.01);
  EngineConfig config;
  ASSERT_TRUE(named_state_groups("gps_ins15", config.groups));
  auto gps_config = default_sensor(SourceKind::gps, "gps0");
  config.sensors = {gps_config};
  FusionEngine engine(config);
  std::uint64_t sequence = 0;
  for (int k = 1; k <= 6000; ++k) {
    Eigen::Vector3d dtheta;
    Eigen::Vector3d dv;
    vehicle.step(dtheta, dv);
    ImuSample imu;
    imu.header.sensor = "imu";
    imu.header.stamp_ns = SurveyRun::kEpochNs + k * 10'000'000LL;
    imu.delta_angle_B_rad = geo::arr(dtheta + normal.vector(3e-6));
    imu.delta_velocity_B_m_s = geo::arr(dv + normal.vector(5e-5));
    imu.delta_time_s = 0.01;
    engine.add(imu);
    if (k % 50 != 0) continue;
    GpsSample gps;
    gps.header = imu.header;
    gps.header.sensor = "gps0";
    gps.header.sequence = ++sequence;
    gps.fix = GpsFix::fix_3d;
    const geo::Geodetic at = geo::moved_by(vehicle.position(), normal.vector(1.0));
    gps.latitude_rad = at.latitude_rad;
    gps.longitude_rad = at.longitude_rad;
    gps.altitude_m = at.altitude_m;
    gps.velocity_N_m_s = geo::arr(vehicle.v_N_m_s() + normal.vector(0.05));
    engine.add(gps);
    Verdict verdict;
    while (engine.next_verdict(verdict)) {
    }
  }
  const NavState& nav = engine.nav_state();
  EXPECT_EQ(nav.mode, NavMode::gps_aided);
  const Eigen::Vector3d rpy = vehicle.rpy_rad();
  EXPECT_LT(std::abs(nav.rpy_rad[0] - rpy.x()), 0.01);
  EXPECT_LT(std::abs(nav.rpy_rad[1] - rpy.y()), 0.01);
  EXPECT_LT(std::abs(geo::wrap_pi(nav.rpy_rad[2] - rpy.z())), 0.03);
  EXPECT_EQ(nav.alignment, AlignmentPhase::aligned);
}

TEST(Alignment, GyrocompassPointsNorth) {
  const double latitude = 0.8;
  for (double heading = -3.0; heading < 3.1; heading += 0.5) {
    const Eigen::Vector3d rpy(0.1, -0.2, heading);
    const Eigen::Matrix3d c = geo::to_matrix(geo::from_rpy(rpy));
    const Eigen::Vector3d rate = c.transpose() * geo::earth_rate_N(latitude);
    const Eigen::Vector3d force = c.transpose() * Eigen::Vector3d(0.0, 0.0, -9.81);
    const Eigen::Vector2d tilt = level(force);
    EXPECT_NEAR(tilt.x(), rpy.x(), 1e-12);
    EXPECT_NEAR(tilt.y(), rpy.y(), 1e-12);
    EXPECT_NEAR(geo::wrap_pi(gyrocompass(tilt, rate) - heading), 0.0, 1e-9);
  }
}

TEST(Alignment, TheTurnWithTheEarthIsNoUnrest) {
  const Eigen::Vector3d rate = geo::earth_rate_N(0.6);
  const Eigen::Vector3d force(0.0, 0.0, -9.8);
  RestWindow still;
  RestWindow swinging;
  for (int i = 0; i < 3000; ++i) {
    still.add(0.01, rate, force);
    swinging.add(0.01, rate + Eigen::Vector3d(0.0, 0.0, 0.01 * std::cos(0.02 * i)), force);
  }
  EXPECT_LT(still.result().rate_sigma_rad_s.maxCoeff(), 1e-9);
  // A swing of 5 mrad to either side, seen over 30 s.
  EXPECT_NEAR(swinging.result().rate_sigma_rad_s.z(), 2.0 * 0.005 / std::sqrt(2.0) / 30.0, 0.1e-3);
}

TEST(Forecast, RadiiHoldTheirShareOfANormalDistribution) {
  for (const double c : {0.0, 0.1, 0.25, 0.5, 0.75, 1.0}) {
    for (const bool median : {true, false}) {
      const double radius = median ? radius_50(2.0, 2.0 * c) : radius_95(2.0, 2.0 * c);
      // Of sigmas 1 and c, by the midpoint rule along the larger axis.
      const double r = 0.5 * radius;
      constexpr int kSlices = 20000;
      double share = 0.0;
      for (int i = 0; i < kSlices; ++i) {
        const double x = (i + 0.5) / kSlices * r;
        const double inside = c > 0.0 ? std::erf(std::sqrt(0.5 * (r * r - x * x)) / c) : 1.0;
        share += 2.0 * r / kSlices * std::exp(-0.5 * x * x) / std::sqrt(2.0 * M_PI) * inside;
      }
      EXPECT_NEAR(share, median ? 0.5 : 0.95, median ? 5e-3 : 1e-3) << c;
    }
  }
  EXPECT_EQ(radius_50(0.0, 0.0), 0.0);
}

TEST(Forecast, DoesNotHangOnOnePingThatSaysNothing) {
  const SurveyRun run({.duration_s = 100.0, .dive_s = 60.0, .usbl = false});
  FusionEngine engine(SurveyRun::config());
  int pings = 0;
  double good_m = kUnknown;
  for (test::Sample sample : run.samples) {
    auto* dvl = std::get_if<DvlSample>(&sample);
    const bool late = test::header(sample).stamp_ns > SurveyRun::kEpochNs + 90 * kNsPerSecond;
    if (dvl == nullptr || !late) {
      test::feed(engine, sample);
      continue;
    }
    const double before_m = engine.forecast_horizontal_95_m(300.0);
    if (++pings == 5) dvl->velocity_D_m_s = {kUnknown, kUnknown, kUnknown};
    test::feed(engine, sample);
    if (pings == 6) {
      EXPECT_LT(before_m, 1.2 * good_m);
    }
    if (pings < 5) good_m = before_m;
  }
  EXPECT_GT(pings, 6);
}

TEST(Forecast, GrowsAndSaysWhenALimitIsPassed) {
  const SurveyRun run({.duration_s = 60.0});
  EngineConfig config = SurveyRun::config();
  config.forecast_limits = {{"horizontal_90cm", 0.9}, {"horizontal_100km", 1e5}, {"heading_half", 0.5}};
  FusionEngine engine(config);
  feed_until(engine, run, 60.0);
  Forecast forecast;
  engine.fill(forecast);
  EXPECT_GT(forecast.horizontal_95_m, 0.5);
  EXPECT_GT(forecast.horizontal_growth_m_s, 0.0);
  // As it is, without any aiding, and without the DVL, the depth sensor and the compass, one by one.
  ASSERT_EQ(forecast.limit_count, 15U);
  EXPECT_EQ(forecast.limits[0].without, Name(""));
  EXPECT_EQ(forecast.limits[3].without, Name("all"));
  EXPECT_EQ(forecast.limits[6].without, Name("dvl0"));
  EXPECT_LT(forecast.limits[3].time_to_limit_s, forecast.limits[0].time_to_limit_s);
  EXPECT_LT(forecast.limits[6].time_to_limit_s, forecast.limits[0].time_to_limit_s);
  EXPECT_LE(forecast.limits[3].time_to_limit_s, forecast.limits[6].time_to_limit_s);
  // The median is less than what holds 95 %.
  EXPECT_GT(forecast.limits[3].time_expected_s, forecast.limits[3].time_to_limit_s);
  EXPECT_EQ(engine.forecast_horizontal_95_m(0.0), forecast.horizontal_95_m);
  EXPECT_TRUE(std::isnan(engine.forecast_horizontal_95_m(std::numeric_limits<double>::infinity())));
  const double at_limit = engine.forecast_horizontal_95_m(forecast.limits[0].time_to_limit_s);
  EXPECT_NEAR(at_limit, 0.9, 0.02);
  EXPECT_EQ(forecast.limits[0].name, Name("horizontal_90cm"));
  EXPECT_GT(forecast.limits[0].time_to_limit_s, 10.0);
  EXPECT_TRUE(std::isinf(forecast.limits[1].time_to_limit_s));
  EXPECT_TRUE(std::isinf(forecast.limits[2].time_to_limit_s));
  // Without the DVL the limit comes sooner.
  Command command;
  command.kind = CommandKind::disable_source;
  command.target = "dvl0";
  ASSERT_EQ(test::order_now(engine, command), "");
  ImuSample next =
      std::get<ImuSample>(*std::find_if(run.samples.rbegin(), run.samples.rend(), [](const test::Sample& s) {
        return std::holds_alternative<ImuSample>(s);
      }));
  next.header.stamp_ns = engine.nav_state().header.stamp_ns + 10'000'000;
  ASSERT_TRUE(engine.add(next));
  Forecast without;
  engine.fill(without);
  EXPECT_LT(without.limits[0].time_to_limit_s, forecast.limits[0].time_to_limit_s);
}

}  // namespace
}  // namespace fathom::estimation
