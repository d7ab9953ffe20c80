// What was refused is believed, and the estimate gets room.
#include "estimation/navigator/reacquisition.hpp"

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
  Reacquisition::make_room({}, instrument, estimate, fix_off_by(3.0, 0.0), 3U, 1.0);
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
  Reacquisition::make_room(policy, instrument, estimate, heading, 1U, 1.0);
  EXPECT_DOUBLE_EQ(estimate.filter(8, 8), before(8, 8) + 0.2 * 0.2);
  EXPECT_EQ(estimate.filter(6, 6), before(6, 6));
  EXPECT_DOUBLE_EQ(estimate.filter(3, 3), before(3, 3) + 0.25 * 0.2 * 0.2);
  EXPECT_DOUBLE_EQ(estimate.filter(3, 8), 0.5 * before(8, 8) + 0.5 * 0.2 * 0.2);
  EXPECT_DOUBLE_EQ(estimate.filter(1, 1), before(1, 1) + 0.25 * 0.2 * 0.2);
  EXPECT_EQ(estimate.filter(1, 8), 0.5 * before(8, 8));
}

}  // namespace
}  // namespace fathom::estimation
