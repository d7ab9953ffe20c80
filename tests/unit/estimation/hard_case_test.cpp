// What a sound engine has to live through: stamps that jitter, samples that are lost, figures that are none,
// a pole.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "geo/wgs84.hpp"
#include "support/orders.hpp"
#include "support/vehicles/spoilt_survey.hpp"

namespace fathom::estimation {
namespace {

using test::SpoiltSurvey;
using test::survey;
using test::survey_with_compass_off;
using test::SurveyRun;

constexpr double kLatitude_rad = 0.6;
constexpr double kTurn_rad_s = 0.1;
constexpr int kRate_hz = 100;
constexpr TimeNs kPeriod_ns = kNsPerSecond / kRate_hz;

/// The increments of a perfect unit that turns about the vertical in one place.
ImuSample turning(std::uint64_t number) {
  const double dt_s = 1.0 / kRate_hz;
  const double psi = kTurn_rad_s * dt_s * (static_cast<double>(number) - 0.5);
  const Eigen::Vector3d earth_N = geo::earth_rate_N(kLatitude_rad);
  ImuSample out;
  out.header.sensor = "imu";
  out.header.sequence = number;
  out.header.stamp_ns = SurveyRun::kEpochNs + static_cast<TimeNs>(number) * kPeriod_ns;
  out.angular_rate_B_rad_s = {std::cos(psi) * earth_N.x(), -std::sin(psi) * earth_N.x(),
                              earth_N.z() + kTurn_rad_s};
  out.specific_force_B_m_s2 = {0.0, 0.0, -geo::gravity(kLatitude_rad, 0.0)};
  out.delta_time_s = dt_s;
  for (std::size_t i = 0; i < 3; ++i) {
    out.delta_angle_B_rad[i] = out.angular_rate_B_rad_s[i] * dt_s;
    out.delta_velocity_B_m_s[i] = out.specific_force_B_m_s2[i] * dt_s;
  }
  return out;
}

EngineConfig unaided() {
  EngineConfig config = SurveyRun::config();
  config.sensors.clear();
  config.imu.nominal_rate_hz = kRate_hz;
  config.alignment.mode = StartMode::given;
  return config;
}

/// After twenty seconds of it, with stamps off by up to `jitter_ns`, without the samples from `lost_from` on.
NavState after_turning(TimeNs jitter_ns, std::uint64_t lost_from, std::uint64_t lost) {
  FusionEngine engine(unaided());
  InitialState initial;
  initial.latitude_rad = kLatitude_rad;
  engine.start_from(initial);
  std::mt19937_64 draw(7);
  for (std::uint64_t number = 0; number <= 20 * kRate_hz; ++number) {
    if (number >= lost_from && number < lost_from + lost) continue;
    ImuSample sample = turning(number);
    if (jitter_ns > 0)
      sample.header.stamp_ns +=
          static_cast<TimeNs>(draw() % static_cast<std::uint64_t>(2 * jitter_ns)) - jitter_ns;
    sample.header.received_ns = sample.header.stamp_ns;
    engine.add(sample);
  }
  return engine.nav_state();
}

double turn_error_rad(const NavState& nav) {
  return std::remainder(nav.rpy_rad[2] - kTurn_rad_s * 20.0, 2.0 * M_PI);
}

TEST(Increments, AreCountedOnceHoweverTheirStampsJitter) {
  for (const TimeNs jitter_ns : {2'000'000, 3'000'000, 4'000'000, 4'900'000}) {
    const NavState nav = after_turning(jitter_ns, 0, 0);
    EXPECT_LT(std::abs(nav.velocity_N_m_s[2]), 0.1) << jitter_ns;
    EXPECT_LT(std::abs(nav.altitude_m), 1.5) << jitter_ns;
    EXPECT_LT(std::abs(turn_error_rad(nav)), 1e-3) << jitter_ns;
  }
}

TEST(Increments, OfSamplesThatAreLostAreFilledIn) {
  for (const TimeNs jitter_ns : {0, 1'000'000, 3'000'000}) {
    const NavState nav = after_turning(jitter_ns, 700, 3);
    // Not filled in they are 30 ms of gravity and of the turn.
    EXPECT_LT(std::abs(nav.velocity_N_m_s[2]), 0.1) << jitter_ns;
    EXPECT_LT(std::abs(turn_error_rad(nav)), 1e-3) << jitter_ns;
  }
}

TEST(HardCase, AVelocityThatIsNoneSpoilsNoStartUnderWay) {
  const SurveyRun run({.duration_s = 48.0, .dive_s = 47.0});
  for (const double wild_m_s : {1e6, 1e20, 1e155, 1e300}) {
    for (int which = 0; which < 6; ++which) {
      FusionEngine engine(SurveyRun::config());
      bool ordered = false;
      int fixes = 0;
      for (test::Sample sample : run.samples) {
        const double t_s = to_seconds(test::header(sample).stamp_ns - SurveyRun::kEpochNs);
        if (!ordered && t_s > 32.0) {
          Command order;
          order.kind = CommandKind::realign;
          ASSERT_EQ(test::order_now(engine, order), "");
          ordered = true;
        }
        if (auto* gps = std::get_if<GpsSample>(&sample); gps != nullptr && ordered && fixes++ == which)
          gps->velocity_N_m_s[0] = wild_m_s;
        test::feed(engine, sample);
      }
      const NavState& nav = engine.nav_state();
      EXPECT_NE(nav.mode, NavMode::none) << wild_m_s << ", fix " << which;
      EXPECT_LT(std::abs(nav.velocity_N_m_s[0]), 10.0) << wild_m_s << ", fix " << which;
      EXPECT_LT(nav.position_covariance_N_m2[0], 100.0) << wild_m_s << ", fix " << which;
    }
  }
}

TEST(HardCase, BeyondAPoleThereIsNoNavigationAndNoFigureThatIsNone) {
  FusionEngine engine(unaided());
  InitialState initial;
  initial.latitude_rad = M_PI / 2.0 - 1e-6;  // 6 m away
  initial.velocity_N_m_s = {3.0, 0.0, 0.0};
  engine.start_from(initial);
  bool lost = false;
  for (std::uint64_t number = 0; number < 60 * kRate_hz; ++number) {
    ImuSample sample = turning(number);
    sample.delta_time_s = kUnknown;
    sample.angular_rate_B_rad_s = {0.0, 0.0, -7.292115e-5};
    sample.specific_force_B_m_s2 = {0.0, 0.0, -geo::gravity(M_PI / 2.0, 0.0)};
    sample.header.received_ns = sample.header.stamp_ns;
    engine.add(sample);
    const NavState& nav = engine.nav_state();
    lost = lost || nav.alignment == AlignmentPhase::lost;
    if (nav.mode == NavMode::none || nav.mode == NavMode::aligning) continue;
    ASSERT_LE(std::abs(nav.latitude_rad), M_PI / 2.0) << number;
    ASSERT_TRUE(std::isfinite(nav.longitude_rad + nav.altitude_m + nav.velocity_N_m_s[0] + nav.q_NB[0]))
        << number;
    ASSERT_TRUE(std::isfinite(nav.position_covariance_N_m2[0])) << number;
  }
  EXPECT_TRUE(lost);
  std::vector<std::byte> image;
  ASSERT_TRUE(engine.save(image));
  FusionEngine again(unaided());
  EXPECT_EQ(again.restore(image), "") << "what is saved can be taken up";
}

TEST(HardCase, ACompassThatIsDisturbedForAMinuteIsNotBelieved) {
  for (const double dive_s : {50.0, 1e9}) {
    const SurveyRun run({.duration_s = 200.0, .dive_s = dive_s});
    for (const double off_deg : {15.0, 40.0, -90.0}) {
      const SpoiltSurvey got = survey_with_compass_off(run, off_deg * kRadPerDeg, 110.0, 170.0, 30.0);
      EXPECT_LT(got.worst_yaw_rad, 3.0 * kRadPerDeg) << off_deg << " deg, dive at " << dive_s;
      EXPECT_LT(got.worst_yaw_sigmas, 4.0) << off_deg << " deg, dive at " << dive_s;
      EXPECT_GT(got.refused, 500) << off_deg << " deg, dive at " << dive_s;
    }
  }
}

TEST(HardCase, ACompassThatWasWrongAtTheStartIsBelievedOnceItHasBeenRightForAsLong) {
  const SurveyRun run({.duration_s = 130.0});
  for (const double off_deg : {30.0, -60.0}) {
    const SpoiltSurvey got = survey_with_compass_off(run, off_deg * kRadPerDeg, 0.0, 55.0, 115.0);
    EXPECT_LT(got.worst_yaw_rad, 0.2 * std::abs(off_deg) * kRadPerDeg) << off_deg;
  }
}

TEST(HardCase, ADvlThatRepeatsItselfWhileTheVehicleTravelsIsFrozen) {
  const SurveyRun run({.duration_s = 130.0});
  std::array<double, 3> held{};
  const auto freeze = [&](test::Sample& sample, double t_s) {
    auto* dvl = std::get_if<DvlSample>(&sample);
    if (dvl == nullptr || t_s >= 120.0) return;
    if (t_s < 90.0) held = dvl->velocity_D_m_s;
    dvl->velocity_D_m_s = held;
  };
  // Thirty seconds at 5 Hz and 1.8 m/s, less the 5 m until it is known.
  const SpoiltSurvey got = survey(run, 30.0, freeze);
  EXPECT_GT(got.frozen, 130);
  EXPECT_LT(got.frozen, 140);
  EXPECT_EQ(survey(run, 30.0, [](test::Sample&, double) {}).frozen, 0);
}

}  // namespace
}  // namespace fathom::estimation
