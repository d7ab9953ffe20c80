// What was refused is believed, and the estimate gets room.
#include "estimation/navigator/reacquisition.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "unit/estimation/navigating.hpp"

namespace fathom::estimation {
namespace {

/// Two rows of a fix so far off, north and east.
Observation fix_off_by(double north_m, double east_m, double sigma_m = 1.0) {
  Observation out;
  out.rows = 2;
  out.innovation = {north_m, east_m};
  out.sigma = {sigma_m, sigma_m};
  out.h[0][0] = out.h[1][1] = 1.0;
  out.list_columns(kNavStates);
  return out;
}

TEST(Reacquisition, RefusedRowsAreBelievedOnceTheyAgreeForLongEnough) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  Estimate estimate = navigating(setup, 1.0);
  SensorConfig sensor;
  sensor.reacquire_s = 5.0;
  Instrument instrument;
  const Reacquisition reacquisition;
  const Observation off = fix_off_by(30.0, -40.0);
  const auto believed = [&](double t_s) {
    estimate.now_ns = kNow_ns + from_seconds(t_s);
    return reacquisition.believed_rows(instrument, sensor, estimate, off, 3U, false, sensor.reacquire_s);
  };
  EXPECT_EQ(believed(0.0), 0U);
  EXPECT_EQ(believed(2.0), 0U);
  EXPECT_EQ(believed(4.9), 0U);
  EXPECT_EQ(believed(5.1), 3U);
  // One that is accepted in between begins the count anew.
  (void)reacquisition.believed_rows(instrument, sensor, estimate, off, 0U, false, sensor.reacquire_s);
  EXPECT_EQ(believed(6.0), 0U);
}

TEST(Reacquisition, AMinorityThatIsAcceptedDoesNotSaveAnEstimateThatIsWrong) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  Estimate estimate = navigating(setup, 1.0);
  SensorConfig sensor;
  sensor.reacquire_s = 5.0;
  const Reacquisition reacquisition;
  const Observation off = fix_off_by(30.0, -40.0);
  /// When rows are first believed; one measurement in so many is accepted, the last of each lot.
  const auto believed_after_s = [&](int one_in) {
    Instrument instrument;
    for (int ping = 0; ping < 200; ++ping) {
      estimate.now_ns = kNow_ns + from_seconds(0.2 * ping);
      const unsigned refused = ping % one_in == one_in - 1 ? 0U : 3U;
      if (reacquisition.believed_rows(instrument, sensor, estimate, off, refused, false,
                                      sensor.reacquire_s) != 0)
        return 0.2 * ping;
    }
    return kUnknown;
  };
  EXPECT_NEAR(believed_after_s(1000), 5.0, 1e-9);
  EXPECT_NEAR(believed_after_s(7), 5.0, 0.3);
  EXPECT_NEAR(believed_after_s(4), 5.0, 0.3);
  EXPECT_FALSE(known(believed_after_s(3)));
  EXPECT_FALSE(known(believed_after_s(2)));
}

TEST(Reacquisition, AFixHasToAgreeWithTheMotion) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  Estimate estimate = navigating(setup, 10.0, 0.01);
  SensorConfig sensor;
  sensor.reacquire_s = 3.0;
  sensor.dispute_s = 0.0;
  const Reacquisition reacquisition;
  const auto try_fixes = [&](double drift_m_s) {
    Instrument instrument;
    unsigned believed = 0;
    for (int second = 0; second <= 8; ++second) {
      estimate.now_ns = kNow_ns + second * kNsPerSecond;
      const Observation off = fix_off_by(60.0 + drift_m_s * second, 0.0);
      believed |=
          reacquisition.believed_rows(instrument, sensor, estimate, off, 3U, true, sensor.reacquire_s);
    }
    return believed;
  };
  EXPECT_EQ(try_fixes(0.0), 3U);
  EXPECT_EQ(try_fixes(30.0), 0U);
}

TEST(Reacquisition, AHeadingHasToBeWrongForAsLongAsItWasRight) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  Estimate estimate = navigating(setup, 10.0);
  estimate.began_ns = kNow_ns;
  estimate.now_ns = kNow_ns + 1000 * kNsPerSecond;
  SensorConfig sensor;
  sensor.reacquire_s = 30.0;
  sensor.dispute_s = 300.0;
  const auto needed_s = [&](double agreed_s, double deviations, bool vouched = false) {
    Instrument instrument;
    instrument.used_ns = kNow_ns + 500 * kNsPerSecond;
    instrument.agrees_since_ns = instrument.used_ns - from_seconds(agreed_s);
    return Reacquisition::heading_needed_s(instrument, sensor, estimate, deviations, vouched);
  };
  // The estimate's own uncertainty explains it.
  EXPECT_DOUBLE_EQ(needed_s(400.0, 5.0), 30.0);
  EXPECT_DOUBLE_EQ(needed_s(400.0, 14.0), 120.0);
  EXPECT_DOUBLE_EQ(needed_s(400.0, 70.0), 300.0);
  // It was right for no longer than it is wrong now, or never.
  EXPECT_DOUBLE_EQ(needed_s(80.0, 70.0), 80.0);
  EXPECT_DOUBLE_EQ(needed_s(10.0, 70.0), 30.0);
  EXPECT_DOUBLE_EQ(Reacquisition::heading_needed_s({}, sensor, estimate, 70.0, false), 30.0);
  EXPECT_DOUBLE_EQ(needed_s(10.0, 70.0, true), 300.0);
  // What was before the start does not count.
  estimate.began_ns = kNow_ns + 460 * kNsPerSecond;
  EXPECT_DOUBLE_EQ(needed_s(400.0, 70.0), 40.0);
}

TEST(Reacquisition, RoomGoesWhereTheRowsLook) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  Estimate estimate = navigating(setup, 1.0);
  const Instrument instrument;
  const ErrorFilter before = estimate.filter;
  Reacquisition reacquisition;
  reacquisition.make_room(setup, {}, false, instrument, estimate, fix_off_by(3.0, 0.0), 3U, 1.0);
  EXPECT_DOUBLE_EQ(estimate.filter(0, 0), before(0, 0) + 9.0);
  for (int i = 1; i < kNavStates; ++i) EXPECT_EQ(estimate.filter(i, i), before(i, i)) << i;
  Observation heading;
  heading.rows = 1;
  heading.innovation[0] = 0.2;
  heading.sigma[0] = 0.01;
  heading.h[0][6] = 0.5;  // pitched
  heading.h[0][8] = -1.0;
  AidingPolicy policy;
  policy.heading_alone = true;
  // The velocity shares half of the heading's error per radian, and so does the place.
  estimate.filter.set(3, 8, 0.5 * before(8, 8));
  estimate.filter.set(1, 8, 0.5 * before(8, 8));
  reacquisition.make_room(setup, policy, false, instrument, estimate, heading, 1U, 1.0);
  EXPECT_DOUBLE_EQ(estimate.filter(8, 8), before(8, 8) + 0.2 * 0.2);
  EXPECT_EQ(estimate.filter(6, 6), before(6, 6));
  EXPECT_DOUBLE_EQ(estimate.filter(3, 3), before(3, 3) + 0.25 * 0.2 * 0.2);
  EXPECT_DOUBLE_EQ(estimate.filter(3, 8), 0.5 * before(8, 8) + 0.5 * 0.2 * 0.2);
  EXPECT_DOUBLE_EQ(estimate.filter(1, 1), before(1, 1) + 0.25 * 0.2 * 0.2);
  EXPECT_EQ(estimate.filter(1, 8), 0.5 * before(8, 8));
}

/// A velocity along east through the medium is off by so much.
Observation through_the_medium(const estimation::Setup& setup, double off_m_s) {
  Observation out;
  out.rows = 1;
  out.innovation[0] = off_m_s;
  out.sigma[0] = 0.01;
  out.h[0][4] = 1.0;
  out.h[0][static_cast<std::size_t>(setup.index.of(Group::current)) + 1] = 1.0;
  out.list_columns(setup.index.size());
  return out;
}

TEST(Reacquisition, ThroughTheMediumRoomIsTheCurrentsWhereTheVelocityOverGroundIsRight) {
  const estimation::Setup setup(EngineConfig{});
  const int current = setup.index.of(Group::current);
  ASSERT_GE(current, 0);
  AidingPolicy policy;
  policy.velocity = VelocityOver::medium;
  policy.shows_level = true;
  for (const bool right : {true, false}) {
    Estimate estimate = navigating(setup, 1.0);
    const ErrorFilter before = estimate.filter;
    Reacquisition reacquisition;
    reacquisition.make_room(setup, policy, right, Instrument{}, estimate, through_the_medium(setup, 0.6), 1U,
                            1.0);
    EXPECT_DOUBLE_EQ(estimate.filter(current + 1, current + 1), before(current + 1, current + 1) + 0.36);
    EXPECT_EQ(estimate.filter(current, current), before(current, current));
    EXPECT_DOUBLE_EQ(estimate.filter(4, 4), before(4, 4) + (right ? 0.0 : 0.36));
    EXPECT_EQ(estimate.filter(6, 6) > before(6, 6), !right);
  }
}

TEST(Reacquisition, ALevelThatGoesWrongAgainIsTheBiases) {
  const estimation::Setup setup(EngineConfig{});
  const int gyro = setup.index.of(Group::gyro_bias);
  const int accel = setup.index.of(Group::accel_bias);
  AidingPolicy policy;
  policy.velocity = VelocityOver::ground;
  policy.shows_level = true;
  Observation off;
  off.rows = 1;
  off.sigma[0] = 0.01;
  off.h[0][3] = 1.0;
  off.list_columns(kNavStates);
  /// Sigmas that are added, of the accelerometer and of the gyro, when 0.5 m/s are wrong again after so long.
  const auto added = [&](double after_s, double off_m_s) {
    Estimate estimate = navigating(setup, 1.0);
    Reacquisition reacquisition;
    off.innovation[0] = off_m_s;
    const ErrorFilter before = estimate.filter;
    reacquisition.make_room(setup, policy, false, Instrument{}, estimate, off, 1U, 1.0);
    EXPECT_EQ(estimate.filter(gyro, gyro), before(gyro, gyro));
    estimate.now_ns += from_seconds(after_s);
    reacquisition.make_room(setup, policy, false, Instrument{}, estimate, off, 1U, 1.0);
    const auto of = [&](int state) {
      return std::sqrt(estimate.filter(state, state) - before(state, state));
    };
    return Eigen::Vector2d(of(accel + 1), of(gyro + 1));
  };
  EXPECT_TRUE(
      added(20.0, 0.5).isApprox(Eigen::Vector2d(0.025, 0.5 / (0.5 * kStandardGravity_m_s2 * 400.0)), 1e-6));
  EXPECT_TRUE(added(1.0, 0.5).isZero());
  EXPECT_TRUE(added(130.0, 0.5).isZero());
  // No unit is that bad.
  EXPECT_TRUE(added(2.0, 5.0).isApprox(Eigen::Vector2d(0.05 * kStandardGravity_m_s2, kRadPerDeg), 1e-6));
}

}  // namespace
}  // namespace fathom::estimation
