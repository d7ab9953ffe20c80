// The navigator's parts, each by itself.
#include <cmath>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/aiding/registry.hpp"
#include "estimation/filter/chi_square.hpp"
#include "estimation/navigator/constraints.hpp"
#include "estimation/navigator/instruments.hpp"
#include "estimation/navigator/reacquisition.hpp"
#include "estimation/navigator/start/alignment_watch.hpp"
#include "estimation/navigator/start/ordered_position.hpp"
#include "estimation/navigator/usage.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

constexpr TimeNs kNow_ns = 1'000 * kNsPerSecond;

/// An estimate at the equator that navigates and knows each axis as well as is said.
Estimate navigating(const estimation::Setup& setup, double position_sigma_m,
                    double velocity_sigma_m_s = 0.1) {
  Estimate estimate(setup);
  estimate.now_ns = kNow_ns;
  std::array<double, kMaxStates> sigma = setup.initial_sigma;
  for (std::size_t i = 0; i < 3; ++i) {
    sigma[i] = position_sigma_m;
    sigma[3 + i] = velocity_sigma_m_s;
    sigma[6 + i] = kRadPerDeg;
  }
  estimate.begin(FilterState{}, sigma);
  return estimate;
}

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

TEST(AlignmentWatch, IsAlignedAfterTheHoldAndFallsOutAtTwiceTheLimit) {
  EngineConfig config;
  config.alignment.aligned_tilt_sigma_rad = 1.0 * kRadPerDeg;
  config.alignment.aligned_heading_sigma_rad = 2.0 * kRadPerDeg;
  config.alignment.aligned_hold_s = 5.0;
  AlignmentWatch watch;
  const auto at = [&](double t_s, double tilt_deg, double heading_deg) {
    const Vector3d sigma = kRadPerDeg * Vector3d(tilt_deg, tilt_deg, heading_deg);
    watch.judge(config, sigma, Plausible::yes, kNow_ns + from_seconds(t_s));
    return watch.phase;
  };
  EXPECT_EQ(at(0.0, 1.1, 1.0), AlignmentPhase::fine);
  EXPECT_EQ(at(1.0, 0.9, 1.9), AlignmentPhase::fine);
  EXPECT_EQ(at(5.9, 0.9, 1.9), AlignmentPhase::fine);
  EXPECT_EQ(at(6.0, 0.9, 1.9), AlignmentPhase::aligned);
  EXPECT_EQ(watch.phase_since_ns, kNow_ns + from_seconds(6.0));
  EXPECT_EQ(at(7.0, 1.9, 3.9), AlignmentPhase::aligned);
  EXPECT_EQ(at(8.0, 1.0, 4.1), AlignmentPhase::fine);
  EXPECT_EQ(watch.hold_since_ns, 0);
}

TEST(AlignmentWatch, WaitsForWhatGravitySaysToComeInAndFallsOutOfWhatCannotBeRight) {
  EngineConfig config;
  config.alignment.aligned_hold_s = 1.0;
  AlignmentWatch watch;
  const auto at = [&](double t_s, Plausible plausible) {
    watch.judge(config, Vector3d::Zero(), plausible, kNow_ns + from_seconds(t_s));
    return watch.phase;
  };
  EXPECT_NE(at(0.0, Plausible::not_heard_enough), AlignmentPhase::aligned);
  EXPECT_NE(at(4.0, Plausible::not_heard_enough), AlignmentPhase::aligned);
  EXPECT_EQ(at(5.0, Plausible::yes), AlignmentPhase::aligned);
  // As one that an older release saved.
  EXPECT_EQ(at(6.0, Plausible::not_heard_enough), AlignmentPhase::aligned);
  EXPECT_EQ(at(7.0, Plausible::no), AlignmentPhase::fine);
  EXPECT_EQ(at(7.5, Plausible::yes), AlignmentPhase::fine);
  EXPECT_EQ(at(8.5, Plausible::yes), AlignmentPhase::aligned);
}

TEST(AlignmentWatch, AsksForNoMoreThanTheAccelerometersCanShow) {
  EngineConfig config;
  config.alignment.aligned_tilt_sigma_rad = 0.1 * kRadPerDeg;
  config.imu.accel_scale_sigma = 0.003;
  config.imu.accel_misalignment_sigma_rad = 0.004;
  EXPECT_NEAR(config.aligned_tilt_sigma_rad(), 0.01, 1e-12);
  config.alignment.aligned_tilt_sigma_rad = 1.0 * kRadPerDeg;
  EXPECT_EQ(config.aligned_tilt_sigma_rad(), 1.0 * kRadPerDeg);
}

TEST(Usage, ModeFollowsWhatWasUsedLast) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  Estimate estimate = navigating(setup, 1.0);
  Usage usage;
  EXPECT_EQ(usage.mode(config, estimate), NavMode::inertial);
  AidingPolicy log;
  log.velocity = VelocityOver::medium;
  usage.note(log, false, kNow_ns);
  EXPECT_EQ(usage.mode(config, estimate), NavMode::dead_reckoning);
  EXPECT_EQ(usage.dvl_used_ns, 0);
  AidingPolicy acoustic;
  acoustic.fix = Fix::acoustic;
  usage.note(acoustic, true, kNow_ns);
  EXPECT_EQ(usage.mode(config, estimate), NavMode::acoustic_aided);
  AidingPolicy satellite;
  satellite.fix = Fix::satellite;
  usage.note(satellite, false, kNow_ns);  // its position was refused: nobody navigates by it
  EXPECT_EQ(usage.mode(config, estimate), NavMode::acoustic_aided);
  usage.note(satellite, true, kNow_ns);
  EXPECT_EQ(usage.mode(config, estimate), NavMode::gps_aided);
  estimate.now_ns += from_seconds(config.gps_timeout_s + 1e-3);
  EXPECT_NE(usage.mode(config, estimate), NavMode::gps_aided);
}

TEST(Usage, OnlyADopplerOverGroundKnowsTheGround) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  const Estimate estimate = navigating(setup, 1.0);
  Usage usage;
  AidingPolicy doppler;
  doppler.doppler = true;
  doppler.velocity = VelocityOver::medium;
  usage.note(doppler, false, kNow_ns);
  EXPECT_EQ(usage.dvl_used_ns, kNow_ns);
  EXPECT_FALSE(usage.knows_ground(config, estimate));
  doppler.velocity = VelocityOver::ground;
  usage.note(doppler, false, kNow_ns);
  EXPECT_TRUE(usage.knows_ground(config, estimate));
}

TEST(InstrumentMemory, AReadingIsFrozenThatStandsStillWhileThePredictionMoves) {
  Instrument instrument;
  const std::array<double, 3> reading{1.0, 2.0, kUnknown};
  const auto frozen = [&](const std::array<double, 3>& now, double predicted, double travelled_m,
                          double way_m = HUGE_VAL) {
    return instrument.is_frozen(now, Vector3d(predicted, 0.0, 0.0), 1.0, Vector3d(0.0, travelled_m, 0.0),
                                way_m);
  };
  EXPECT_FALSE(frozen(reading, 0.0, 0.0));
  EXPECT_FALSE(frozen(reading, 0.9, 0.0));
  EXPECT_TRUE(frozen(reading, 1.1, 0.0));
  EXPECT_FALSE(frozen({1.0, 2.0 + 1e-12, kUnknown}, 1.1, 0.0));
  // Or while the vehicle travels, where no live instrument repeats itself; a simulator without noise may.
  EXPECT_FALSE(frozen(reading, 0.0, 0.0, 5.0));
  EXPECT_FALSE(frozen(reading, 0.0, 99.0, 5.0));
  for (int i = 0; i < 20; ++i) {
    (void)frozen({0.01 * i, 0.0, 0.0}, 0.0, 0.0);
    instrument.note_innovation(1.0);
  }
  EXPECT_FALSE(frozen(reading, 0.0, 100.0, 5.0));
  EXPECT_FALSE(frozen(reading, 0.0, 104.0, 5.0));
  EXPECT_TRUE(frozen(reading, 0.0, 106.0, 5.0));
  EXPECT_FALSE(frozen(reading, 0.0, 106.0));
  // What has nothing to say never repeats itself.
  const std::array<double, 3> silence{kUnknown, kUnknown, kUnknown};
  EXPECT_FALSE(frozen(silence, 0.0, 0.0, 5.0));
  EXPECT_FALSE(frozen(silence, 99.0, 99.0, 5.0));
}

TEST(OrderedPosition, AFarOneIsHeldUntilTheSamePlaceIsConfirmed) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  Estimate estimate = navigating(setup, 10.0);
  OrderedPosition ordered;
  Command order;
  order.kind = CommandKind::set_position;
  order.latitude_rad = 1e-2;  // 64 km
  order.longitude_rad = 0.0;
  order.sigma_m = 1.0;
  EXPECT_EQ(ordered.propose(setup, estimate, order).judgement.kind, VerdictKind::rejected);
  order.confirmed = true;
  Command elsewhere = order;
  elsewhere.latitude_rad = 2e-2;
  EXPECT_EQ(ordered.propose(setup, estimate, elsewhere).judgement.kind, VerdictKind::rejected);
  EXPECT_EQ(ordered.propose(setup, estimate, order).judgement.kind, VerdictKind::rejected);
  const OrderedPosition::Step step = ordered.propose(setup, estimate, order);
  EXPECT_EQ(step.judgement.kind, VerdictKind::used);
  EXPECT_NEAR(step.step_N_m.x(), 63'357.0, 50.0);
  EXPECT_EQ(step.axes, 2);
  EXPECT_EQ(ordered.held_ns, 0);
  // A confirmation comes within a minute.
  order.confirmed = false;
  (void)ordered.propose(setup, estimate, order);
  order.confirmed = true;
  estimate.now_ns += from_seconds(61.0);
  EXPECT_EQ(ordered.propose(setup, estimate, order).judgement.kind, VerdictKind::rejected);
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

TEST(Constraints, RestIsTakenForAVelocityOnceASecond) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  Estimate estimate = navigating(setup, 1.0, 1.0);
  estimate.state.nav.v_N_m_s = {0.5, -0.5, 0.1};
  Constraints constraints;
  ImuStep step;
  EXPECT_FALSE(constraints.apply(setup, step, estimate));
  constraints.mark_at_rest(estimate.now_ns, 1.5);
  EXPECT_TRUE(constraints.apply(setup, step, estimate));
  EXPECT_LT(estimate.state.nav.v_N_m_s.norm(), 0.05);
  EXPECT_FALSE(constraints.apply(setup, step, estimate));
  estimate.now_ns += kNsPerSecond;
  EXPECT_TRUE(constraints.apply(setup, step, estimate));
  estimate.now_ns += kNsPerSecond;
  EXPECT_FALSE(constraints.apply(setup, step, estimate));
}

TEST(AidingPolicies, EachModelSaysWhatItBrings) {
  const SensorConfig sensor;
  int fixes = 0;
  int velocities = 0;
  for (const AidingEntry& entry : aiding_registry()) {
    // A sample of the entry's kind in which nothing is known.
    EventSample sample;
    for_each_aiding_kind([&](auto kind) {
      if (kind.kSource == entry.source) sample = typename decltype(kind)::Sample{};
    });
    const AidingPolicy policy = entry.policy(sensor, sample);
    fixes += policy.position ? 1 : 0;
    velocities += policy.velocity != VelocityOver::none ? 1 : 0;
    EXPECT_TRUE(!policy.follows_motion || policy.position) << entry.name;
    for (const double value : policy.reading)
      EXPECT_TRUE(std::isnan(value) || value == 0.0) << entry.name << " repeats what nobody said";
  }
  EXPECT_EQ(fixes, 6);
  EXPECT_GE(velocities, 8);
}

AidingPolicy policy_of(std::string_view model, const EventSample& sample) {
  for (const AidingEntry& entry : aiding_registry())
    if (entry.name == model) return entry.policy({}, sample);
  ADD_FAILURE() << "no model " << model;
  return {};
}

TEST(AidingPolicies, APartOfAnAcousticFixIsNoPosition) {
  UsblSample usbl;
  usbl.frame = UsblFrame::vehicle_frd;
  usbl.range_m = 120.0;
  EXPECT_EQ(policy_of("usbl_range_bearing", usbl).fix, Fix::none);
  usbl.depression_rad = 0.2;
  EXPECT_EQ(policy_of("usbl_range_bearing", usbl).fix, Fix::none);
  usbl.bearing_rad = 1.0;
  EXPECT_EQ(policy_of("usbl_range_bearing", usbl).fix, Fix::acoustic);
  UsblSample vector;
  vector.relative_m = {kUnknown, 3.0, 5.0};
  EXPECT_EQ(policy_of("usbl_vector", vector).fix, Fix::none);
  vector.relative_m[0] = 2.0;
  EXPECT_EQ(policy_of("usbl_vector", vector).fix, Fix::acoustic);
}

TEST(AidingPolicies, ABarometerAloneIsNoVelocity) {
  AirspeedSample air;
  air.baro_altitude_m = 300.0;
  EXPECT_EQ(policy_of("baro_altitude", air).velocity, VelocityOver::none);
  EXPECT_EQ(policy_of("airspeed", air).velocity, VelocityOver::medium);
}

TEST(ChiSquare, QuantilesAreThoseOfTheTables) {
  EXPECT_NEAR(chi_square_quantile(0.95, 1), 3.841458821, 1e-8);
  EXPECT_NEAR(chi_square_quantile(0.95, 2), 5.991464547, 1e-8);
  EXPECT_NEAR(chi_square_quantile(0.99, 3), 11.344866730, 1e-8);
  EXPECT_NEAR(chi_square_quantile(0.999, 6), 22.457744484, 1e-8);
}

}  // namespace
}  // namespace fathom::estimation
