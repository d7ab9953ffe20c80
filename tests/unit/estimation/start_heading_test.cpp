// The heading of the start as something that may have been wrong (GATE-8, GATE-9).
#include "estimation/doubt/start_heading.hpp"

#include <cmath>
#include <string>
#include <type_traits>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/navigator/navigator.hpp"
#include "estimation/smoothing/filter_log.hpp"
#include "geo/so3.hpp"
#include "support/vehicles/analytic_vehicle.hpp"
#include "support/vehicles/spoilt_survey.hpp"
#include "unit/estimation/linear_loop.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using test::Normal;
using test::SurveyRun;

constexpr int kStates = 17;
constexpr int kBias = 15;  ///< of a compass

StartHeading::Column by_compass() {
  StartHeading::Column column{};
  column[8] = 1.0;
  column[kBias] = -1.0;
  return column;
}

ErrorFilter known_to(double heading_rad) {
  std::array<double, kMaxStates> sigma{};
  for (std::size_t i = 0; i < kStates; ++i) sigma[i] = i < 3 ? 2.0 : i < 6 ? 0.1 : i < 15 ? 1e-4 : 0.017;
  sigma[8] = heading_rad;
  ErrorFilter filter(kStates);
  filter.reset(sigma);
  return filter;
}

/// Eight seconds of a compass, a speed log along the vehicle and fixes, while it speeds up: both loops see
/// the same, `start` what the first one does.
void run(double wrong_rad, std::uint64_t seed, LinearLoop& believing, LinearLoop& open, StartHeading& start) {
  Normal normal(seed);
  NavSolution nav;
  nav.position = {0.6, 0.2, 10.0};
  nav.q_NB = geo::from_rpy({0.0, 0.0, 0.8});
  const StateIndex index{StateGroups{}};
  ProcessNoise noise;
  noise.velocity = 1e-4 * Eigen::Matrix3d::Identity();
  noise.attitude = 1e-10 * Eigen::Matrix3d::Identity();
  for (LinearLoop* loop : {&believing, &open}) {
    loop->error(8) = wrong_rad;
    loop->error(kBias) = -wrong_rad;
  }
  start.begin(by_compass());
  for (int k = 0; k < 80; ++k) {
    nav.v_N_m_s = 0.05 * k * Vector3d(1.0, 0.3, 0.0);
    const NavTransition step(index, nav, Vector3d(0.0, 0.0, 0.02), Vector3d(0.2, 0.0, -9.8), 0.1);
    for (LinearLoop* loop : {&believing, &open}) {
      loop->filter.propagate(step, noise);
      loop->propagate_error(step, kStates - 2);
    }
    start.propagated(step, noise);
    Observation seen;
    seen.rows = 3;
    seen.h[0][8] = -1.0;
    seen.h[0][kBias] = -1.0;
    seen.h[1][3] = seen.h[2][4] = 1.0;
    seen.h[1][8] = -nav.v_N_m_s.y();
    seen.h[2][8] = nav.v_N_m_s.x();
    seen.sigma = {0.01, 0.02, 0.02};
    if (k % 5 == 0) {
      seen.rows = 5;
      seen.h[3][0] = seen.h[4][1] = 1.0;
      seen.sigma[3] = seen.sigma[4] = 0.5;
    }
    seen.list_columns(kStates);
    LinearLoop::Noise drawn = LinearLoop::Noise::Zero();
    for (int r = 0; r < seen.rows; ++r) drawn(r) = normal(seen.sigma[static_cast<std::size_t>(r)]);
    believing.take_in(seen, drawn, [&](const Observation& taken, const InnovationStatistics& statistics) {
      start.updated(taken, statistics, believing.filter, 0.0);
    });
    open.take_in(seen, drawn);
  }
}

// What it finds is what a filter finds that knew nothing of the heading: its error and its covariance.
TEST(StartHeading, FindsWhatAFilterFindsThatWasToldNothingOfTheHeading) {
  for (const double wrong_deg : {-20.0, 8.0}) {
    LinearLoop believing(known_to(1.0 * kRadPerDeg));
    ErrorFilter unknown = believing.filter;
    constexpr double kNothing_rad = 30.0;
    unknown.shift(by_compass(), 0.0, kNothing_rad * kNothing_rad);
    LinearLoop open(unknown);
    StartHeading start;
    run(wrong_deg * kRadPerDeg, 3, believing, open, start);
    ASSERT_TRUE(start.is_wrong());
    const double found_rad = start.error_rad();
    EXPECT_NEAR(found_rad, wrong_deg * kRadPerDeg, 4.0 * std::sqrt(start.variance_rad2()));
    // Forgetting over eight of its sixty seconds, and the last measurement, are what is left between the two.
    constexpr double kForgotten = 0.05;
    believing.filter.shift(start.column(), found_rad, start.variance_rad2());
    for (int i = 0; i < kStates; ++i) {
      const double sigma = std::sqrt(open.filter(i, i));
      const double left = believing.error(i) - found_rad * start.column()[static_cast<std::size_t>(i)];
      EXPECT_NEAR(left, open.error(i), kForgotten * sigma) << i;
      EXPECT_NEAR(std::sqrt(believing.filter(i, i)), sigma, kForgotten * sigma) << i;
    }
    start.corrected();
    EXPECT_FALSE(start.is_wrong());
  }
}

TEST(StartHeading, IsNotDoubtedForWhatItsSigmaAllows) {
  int doubted = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Normal normal(1000 + seed);
    LinearLoop believing(known_to(1.0 * kRadPerDeg));
    LinearLoop open(believing.filter);
    StartHeading start;
    // Heading and compass are wrong by the same: what is drawn lies along that.
    run(normal(0.7 * kRadPerDeg), seed, believing, open, start);
    doubted += start.is_wrong() ? 1 : 0;
  }
  EXPECT_EQ(doubted, 0);
}

// A single reading that is far off says much of itself and next to nothing of the start.
TEST(StartHeading, NoSingleReadingDecides) {
  LinearLoop believing(known_to(1.0 * kRadPerDeg));
  LinearLoop open(believing.filter);
  StartHeading start;
  run(0.0, 5, believing, open, start);
  Observation heading;
  heading.rows = 1;
  heading.h[0][8] = -1.0;
  heading.h[0][kBias] = -1.0;
  heading.sigma[0] = 0.01;
  heading.list_columns(kStates);
  LinearLoop::Noise far = LinearLoop::Noise::Zero();
  far(0) = 1.0;
  believing.take_in(heading, far, [&](const Observation& taken, const InnovationStatistics& statistics) {
    start.updated(taken, statistics, believing.filter, 0.0);
  });
  EXPECT_FALSE(start.is_wrong());
}

// One instrument is off by what is considered of it, in all measurements alike: however many say the same,
// they know the heading no better than that.
TEST(StartHeading, WhatIsConsideredDoesNotAverageOut) {
  for (const double considered : {0.0, 0.05}) {
    StateGroups groups;
    groups.accel_scale = true;
    const StateIndex index(StateGroups{}, groups);
    const int other = index.of(Group::accel_scale);
    std::array<double, kMaxStates> sigma{};
    for (std::size_t i = 0; i < 15; ++i) sigma[i] = 1e-4;
    sigma[static_cast<std::size_t>(other)] = considered;
    ErrorFilter filter(index);
    filter.reset(sigma);
    LinearLoop loop(filter);
    loop.error(other) = 0.06;
    StartHeading start;
    StartHeading::Column column{};
    column[8] = 1.0;
    start.begin(column);
    NavSolution nav;
    nav.position = {0.6, 0.2, 10.0};
    const NavTransition step(index, nav, Vector3d::Zero(), Vector3d(0.0, 0.0, -9.8), 1.0);
    for (int k = 0; k < 100; ++k) {
      loop.filter.propagate(step, ProcessNoise{});
      start.propagated(step, ProcessNoise{});
      Observation seen;
      seen.rows = 1;
      seen.h[0][8] = seen.h[0][static_cast<std::size_t>(other)] = 1.0;
      seen.sigma[0] = 0.02;
      seen.list_columns(index.size());
      loop.take_in(seen, LinearLoop::Noise::Zero(),
                   [&](const Observation& taken, const InnovationStatistics& statistics) {
                     start.updated(taken, statistics, loop.filter, 0.0);
                   });
    }
    EXPECT_NEAR(start.error_rad(), 0.06, 0.015);
    EXPECT_EQ(start.is_wrong(), considered == 0.0) << considered;
    if (considered > 0.0) {
      EXPECT_NEAR(std::sqrt(start.variance_rad2()), considered, 0.1 * considered);
    }
  }
}

// Of what has been found all the time before was wrong as well (SMOOTH-6).
TEST(StartHeading, IsNotJudgedByVelocitiesAlongTheVehicle) {
  // They do not see which way its axes point; a velocity of GPS does.
  const auto evidence = [](const auto& sample, int sensor) {
    const estimation::Setup setup(SurveyRun::config());
    Navigator navigator(setup);
    InitialState state;
    state.latitude_rad = 0.6;
    state.position_sigma_N_m = {1.0, 1.0, 1.0};
    state.velocity_sigma_N_m_s = {0.1, 0.1, 0.1};
    state.attitude_sigma_rad = {0.01, 0.01, 0.02};
    state.velocity_N_m_s = {1.0, 0.0, 0.0};
    const TimeNs begin_ns = SurveyRun::kEpochNs;
    navigator.start(state, begin_ns);
    for (int k = 0; k < 500; ++k) {
      ImuStep step;
      step.from_ns = begin_ns + static_cast<TimeNs>(k) * 10'000'000;
      step.to_ns = step.from_ns + 10'000'000;
      Increments& in = step.increments;
      in.dt_s = 0.01;
      in.dtheta_rad = in.dtheta_before_rad = 0.01 * geo::earth_rate_N(0.6);
      in.dv_m_s = in.dv_before_m_s = Vector3d(0.0, 0.0, -0.01 * geo::gravity(0.6, 0.0));
      navigator.advance(step, step.to_ns);
      if (k % 20 == 0) {
        Measurement one;
        one.stamp_ns = step.to_ns;
        one.source = kSourceOf<std::remove_cvref_t<decltype(sample)>>;
        one.sensor = sensor;
        auto now = sample;
        now.header.stamp_ns = step.to_ns;
        one.sample = now;
        EXPECT_EQ(navigator.apply(one).kind, VerdictKind::used) << k;
      }
      navigator.finish(step);
    }
    const StartHeading& start = navigator.estimate().start_heading;
    EXPECT_TRUE(start.is_open());
    return 1.0 / start.variance_rad2();
  };
  DvlSample dvl;
  dvl.velocity_D_m_s = {1.0, 0.0, 0.0};
  GpsSample gps;
  gps.fix = GpsFix::fix_3d;
  gps.velocity_N_m_s = {1.0, 0.0, 0.0};
  gps.latitude_rad = gps.longitude_rad = gps.altitude_m = kUnknown;
  EXPECT_GT(evidence(gps, 0), 0.0);
  EXPECT_FALSE(evidence(dvl, 1) > 0.0);
}

TEST(StartHeading, WhatIsFoundHoldsBeforeIt) {
  ErrorFilter filter = known_to(1.0 * kRadPerDeg);
  FilterLog log(kStates);
  filter.record_to(&log);
  const ErrorFilter before = filter;
  filter.shift(by_compass(), 0.3, 0.01);
  Observation heading;  // of two antennas, behind it
  heading.rows = 1;
  heading.h[0][8] = -1.0;
  heading.innovation[0] = -0.05;
  heading.sigma[0] = 0.002;
  heading.list_columns(kStates);
  InnovationStatistics statistics;
  filter.statistics(heading, 1.0, statistics);
  std::array<double, kMaxStates> found{};
  ASSERT_TRUE(filter.update(heading, statistics, found));
  Adjoint adjoint(kStates);
  log.back_through(log.size(), 0, adjoint);
  std::array<double, kMaxStates> x{};
  adjoint.smoothed_error(before, x);
  EXPECT_NEAR(x[8], 0.3 + found[8], 1e-12);
  EXPECT_NEAR(x[kBias], -0.3 + found[kBias], 1e-12);
  ErrorFilter smoothed = before;
  const std::array<int, 2> states{8, kBias};
  adjoint.smooth_covariance(states, smoothed);
  for (const int i : states) EXPECT_NEAR(smoothed(i, i), filter(i, i), 1e-9 * filter(i, i));
}

TEST(StartHeading, ACompassBesideSteelAtTheStartIsFoundOutByTheWay) {
  const SurveyRun run({.duration_s = 130.0});
  for (const double off_deg : {-20.0, 15.0, 20.0})
    for (const double until_s : {15.0, 45.0}) {
      const test::SpoiltSurvey got =
          test::survey_with_compass_off(run, off_deg * kRadPerDeg, 0.0, until_s, 60.0);
      EXPECT_LT(got.worst_h_sigmas, 3.7) << off_deg << " deg until " << until_s;
      EXPECT_LT(got.worst_yaw_rad, 3.0 * kRadPerDeg) << off_deg << " deg until " << until_s;
      EXPECT_LT(got.last_yaw_rad, 1.5 * kRadPerDeg) << off_deg << " deg until " << until_s;
      const auto said = got.advice.find("wrong by ");
      ASSERT_NE(said, std::string::npos) << got.advice;
      EXPECT_NEAR(std::stod(got.advice.substr(said + 9)), off_deg, 0.4 * std::abs(off_deg)) << got.advice;
    }
  EXPECT_EQ(test::survey(run, 60.0, [](test::Sample&, double) {}).advice, "");
}

// Who dives right from the ship has fixes of two metres, and seconds between them. Of a large angle the place
// is off across what is linear in it as well: an arc ends short of its tangent.
TEST(StartHeading, IsTakenOutUnderWaterAsWell) {
  for (const double dive_s : {14.0, 60.0}) {
    const SurveyRun run({.duration_s = 240.0, .dive_s = dive_s, .seed = 2});
    for (const double off_deg : {-20.0, 15.0, 30.0}) {
      const test::SpoiltSurvey got =
          test::survey_with_compass_off(run, off_deg * kRadPerDeg, 0.0, 40.0, 90.0);
      EXPECT_LT(got.worst_h_sigmas, 3.7) << off_deg << " deg, dive after " << dive_s;
      EXPECT_LT(got.worst_yaw_sigmas, 3.0) << off_deg << " deg, dive after " << dive_s;
      EXPECT_LT(got.last_yaw_rad, 0.4 * kRadPerDeg) << off_deg << " deg, dive after " << dive_s;
    }
  }
}

}  // namespace
}  // namespace fathom::estimation
